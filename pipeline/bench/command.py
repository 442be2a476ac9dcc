# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The options of ``nightcity bench`` and of its tables."""

from __future__ import annotations

import argparse
from pathlib import Path

from nightcity.bench.options import (
    add_scenes,
    add_views,
    check,
    judge_tolerance,
    names,
    number,
    numbers,
    wholes,
)
from nightcity.bench.peer_commands import add_cycles, add_mitsuba
from nightcity.errors import UsageError


def add_arguments(command: argparse.ArgumentParser) -> None:
    """The plain command, and one sub-command for each table."""
    command.add_argument(
        "--town", type=Path, action="append", default=[], help="a CityJSON file to measure as well"
    )
    command.add_argument(
        "--preset",
        action="append",
        help="a generator preset (default: paper-4x4 and city-100x100)",
    )
    command.add_argument(
        "--cameras",
        type=names,
        default=["overview75"],
        metavar="NAMES",
        help="through which every method is timed on the first scene (default: overview75)",
    )

    def run(options: argparse.Namespace) -> None:
        from nightcity.bench.steps import bench

        bench(options.preset or ["paper-4x4", "city-100x100"], options.town, options.cameras)

    command.set_defaults(run=run)
    tables = command.add_subparsers(
        dest="table",
        metavar="TABLE",
        help="without one: time, memory and size of every step, and every method beside the march",
    )
    for add in (_accuracy, _ladder, add_mitsuba, add_cycles, _growth, _paper, _flicker):
        add(tables)


def _accuracy(tables: argparse._SubParsersAction) -> None:
    table = tables.add_parser(
        "accuracy",
        help="every method against the judge, at pixels chosen at random",
        description="Exit code 1 where a line misses its bar: p99 within the tolerance (p95 "
        "below 1,000 pixels); of path, means within three standard errors, no pixel beyond "
        "Sidak's bound, standard error of the mean at most 0.5 %; of field also an estimate "
        "of the error that is exceeded in at most 1 % of the pixels, its median at most 10 times "
        "the error's.",
    )
    add_scenes(table, "paper-4x4 and mixed-6x6, where no town is named either")
    add_views(table)
    table.add_argument("--methods", type=names, default=["path"], metavar="NAMES")
    table.add_argument("--tolerances", type=numbers, default=[0.01, 0.001], metavar="T,...")
    table.add_argument(
        "--emitters", type=names, default=["isotropic", "lambertian", "pane"], metavar="NAMES"
    )
    table.add_argument("--lights", default="all", choices=("listed", "all"))
    table.add_argument("--visibility", default="full", choices=("none", "full"))
    table.add_argument("--scattering", default="single", choices=("single", "multiple"))
    table.add_argument("--surfaces", default="dim", choices=("dim", "lit"))
    table.add_argument("--pixels", type=int, default=2000, help="of generated cities (%(default)s)")
    table.add_argument("--town-pixels", type=int, default=300, help="of towns (%(default)s)")
    table.add_argument(
        "--samples",
        type=int,
        default=16384,
        help="paths a pixel of path, with --scattering multiple of the truth (%(default)s)",
    )
    table.add_argument(
        "--judge-tolerance",
        type=judge_tolerance,
        metavar="auto|T",
        help="of the judge, which converges to a tenth of it; auto (default): the smallest of "
        "--tolerances, a tenth of it where the methods hold reference itself",
    )

    def run(options: argparse.Namespace) -> int:
        from nightcity.bench.accuracy import METHODS, AccuracyOptions, accuracy

        check("--methods", options.methods, METHODS)
        check("--emitters", options.emitters, ("isotropic", "lambertian", "pane"))
        chosen = AccuracyOptions(
            options.methods,
            options.tolerances,
            options.emitters,
            options.cameras,
            options.lights,
            options.visibility,
            options.size,
            options.pixels,
            options.town_pixels,
            options.scattering,
            options.surfaces,
            options.samples,
            options.judge_tolerance,
            options.judged,
        )
        usual = [] if options.town else ["paper-4x4", "mixed-6x6"]
        return accuracy(options.scene or usual, options.town, chosen)

    table.set_defaults(run=run)


def _ladder(tables: argparse._SubParsersAction) -> None:
    table = tables.add_parser(
        "ladder",
        help="what each physical term changes, against the richest model and one switch at a time",
        description="Centre: both models at the pixel's centre. Integrated: both as means over 64 "
        "places of the pixel.",
    )
    table.add_argument(
        "scene", nargs="?", default="paper-4x4", metavar="SCENE", help="(default: %(default)s)"
    )
    table.add_argument(
        "--extinctions",
        type=numbers,
        metavar="E,...",
        help="of a preset's haze, 1/m (default: 0.001 to 0.1 in five steps for a preset)",
    )
    table.add_argument("--pixels", type=int, default=200, help="(default: %(default)s)")
    table.add_argument(
        "--integrated-pixels", type=int, default=50, help="(default: %(default)s; 0: none)"
    )
    table.add_argument(
        "--samples", type=int, default=16384, help="paths a pixel (default: %(default)s)"
    )
    add_views(table)

    def run(options: argparse.Namespace) -> int:
        from nightcity.bench.ladder import EXTINCTIONS, LadderOptions, ladder
        from nightcity.city.parameters import preset_names

        sweep = EXTINCTIONS if options.scene in preset_names() else None
        chosen = LadderOptions(
            options.cameras,
            options.extinctions or sweep,
            options.size,
            options.pixels,
            options.integrated_pixels,
            options.samples,
            options.judged,
        )
        return ladder(options.scene, chosen)

    table.set_defaults(run=run)


def _growth(tables: argparse._SubParsersAction) -> None:
    table = tables.add_parser(
        "growth",
        help="how every step grows with the city, as a table and a chart on logarithmic axes",
        description="Writes growth.csv, growth.svg and growth.png. A step that fails or takes "
        "longer than the limit is left out from that city on, and said. Run again with the same "
        "folder, it goes on after the last step; growth.json keeps what is measured.",
    )
    table.add_argument("-o", "--output", type=Path, required=True, metavar="FOLDER")
    table.add_argument(
        "--grids",
        type=wholes,
        default=[4, 8, 16, 30, 60, 100, 300],
        metavar="N,...",
        help="cities of N x N buildings (default: 4,8,16,30,60,100,300)",
    )
    table.add_argument(
        "--preset", default="city-100x100", help="what else they are like (default: %(default)s)"
    )
    table.add_argument(
        "--methods",
        type=names,
        default=["surface", "march", "gauss", "field"],
        metavar="NAMES",
        help="frames to time, of surface, march, gauss and field (default: all)",
    )
    table.add_argument("--camera", default="overview75", help="(default: %(default)s)")
    table.add_argument("--size", default="1920x1061", metavar="WIDTHxHEIGHT")
    table.add_argument(
        "--limit", type=number, default=600, metavar="SECONDS", help="a step (default: 600)"
    )

    def run(options: argparse.Namespace) -> None:
        from nightcity.bench.growth import FRAMES, GrowthOptions, growth

        check("--methods", options.methods, tuple(FRAMES))
        chosen = GrowthOptions(
            options.grids, options.preset, options.methods, options.camera, options.size,
            options.limit,
        )  # fmt: skip
        growth(options.output, chosen)

    table.set_defaults(run=run)


def _paper(tables: argparse._SubParsersAction) -> None:
    table = tables.add_parser(
        "paper",
        help="the paper's three tables beside ours: steps, screen coverage, size of the city",
        description="The march in both forms, the surface frame and field, in turn; in brackets "
        "the ratio to the table's standard row, on both sides.",
    )
    table.add_argument(
        "tables", nargs="*", metavar="TABLE", help="steps, coverage or grid (default: all three)"
    )
    table.add_argument(
        "--tolerance", type=number, default=0.01, help="of field (default: %(default)s)"
    )
    table.add_argument("--rounds", type=int, default=3, help="(default: %(default)s)")
    table.add_argument("--size", default="1920x1061", metavar="WIDTHxHEIGHT")
    table.add_argument(
        "--grids",
        type=wholes,
        default=[],
        metavar="N,...",
        help="cities of N x N buildings beyond the paper's four",
    )

    def run(options: argparse.Namespace) -> None:
        from nightcity.bench.paper import TABLES, PaperOptions, paper_tables

        tables = options.tables or list(TABLES)
        check("TABLE", tables, tuple(TABLES))
        if options.rounds < 1:
            raise UsageError(f"--rounds {options.rounds}: at least 1")
        paper_tables(
            PaperOptions(tables, options.size, options.grids, options.tolerance, options.rounds)
        )

    table.set_defaults(run=run)


def _flicker(tables: argparse._SubParsersAction) -> None:
    table = tables.add_parser(
        "flicker",
        help="how steady the error of every method is from frame to frame of a shot",
        description="A patch of 16 pixels in every frame, against the judge.",
    )
    table.add_argument(
        "scene",
        nargs="?",
        metavar="SCENE",
        help="a stage or flat scene with frames (default: 24 frames over 30 x 30 buildings, "
        "18:00 to 02:00)",
    )
    table.add_argument("--methods", type=names, default=["gauss", "field"], metavar="NAMES")
    table.add_argument("--tolerance", type=number, default=0.01, help="(default: %(default)s)")
    table.add_argument(
        "--emitter", default="lambertian", choices=("isotropic", "lambertian", "pane")
    )
    table.add_argument("--camera", default="flight", help="(default: %(default)s)")
    table.add_argument("--size", default="1920x1061", metavar="WIDTHxHEIGHT")
    table.add_argument(
        "--frames", type=wholes, default=[1, 24], metavar="FIRST,LAST", help="(default: 1,24)"
    )

    def run(options: argparse.Namespace) -> None:
        from nightcity.bench.flicker import METHODS, FlickerOptions, flicker

        check("--methods", options.methods, METHODS)
        chosen = FlickerOptions(
            options.methods, options.tolerance, options.emitter, options.camera, options.size,
            (options.frames[0], options.frames[-1]),
        )  # fmt: skip
        flicker(options.scene, chosen)

    table.set_defaults(run=run)
