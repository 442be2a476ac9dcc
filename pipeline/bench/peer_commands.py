# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The options of ``nightcity bench mitsuba`` and ``nightcity bench cycles``."""

from __future__ import annotations

import argparse

from nightcity.bench.options import add_environment, add_judged, add_views, number


def add_mitsuba(tables: argparse._SubParsersAction) -> None:
    """An independent renderer against the judge."""
    table = tables.add_parser(
        "mitsuba",
        help="an independent renderer, Mitsuba 3, against the judge on the same rays",
        description="Single scattering from panes, all lights, full visibility. Exit code 1 where "
        "the means are more than three standard errors apart.",
    )
    table.add_argument(
        "scene",
        nargs="?",
        default="paper-4x4",
        metavar="SCENE",
        help="one haze that fills a box around the buildings (default: %(default)s)",
    )
    add_environment(table, "mitsuba", "Mitsuba and LLVM 19")
    table.add_argument("--pixels", type=int, default=300, help="(default: %(default)s)")
    table.add_argument(
        "--samples", type=int, default=2048, help="paths a pixel and pass (default: %(default)s)"
    )
    table.add_argument("--passes", type=int, default=32, help="(default: %(default)s)")
    add_views(table)

    def run(options: argparse.Namespace) -> int:
        from nightcity.bench.independent import PeerOptions, bench_mitsuba

        chosen = PeerOptions(
            options.cameras,
            options.size,
            options.pixels,
            options.samples,
            options.passes,
            options.judged,
            options.environment,
            options.install,
        )
        return bench_mitsuba(options.scene, chosen)

    table.set_defaults(run=run)


def add_cycles(tables: argparse._SubParsersAction) -> None:
    """Time to equal error."""
    table = tables.add_parser(
        "cycles",
        help="how long Cycles and field take to the same error of an image",
        description="Single scattering from panes, full visibility, pixel-integrated; bake and "
        "first frame included.",
    )
    table.add_argument(
        "scene",
        nargs="?",
        default="paper-4x4",
        metavar="SCENE",
        help="one haze that fills a box around the buildings (default: %(default)s)",
    )
    table.add_argument("--camera", default="overview75", help="(default: %(default)s)")
    table.add_argument("--size", default="480x265", metavar="WIDTHxHEIGHT")
    table.add_argument("--pixels", type=int, default=300, help="judged (default: %(default)s)")
    table.add_argument("--error", type=number, default=0.03, help="median (default: %(default)s)")
    table.add_argument(
        "--samples", type=int, default=256, help="of Cycles, a pixel and pass (%(default)s)"
    )
    table.add_argument(
        "--limit", type=number, default=600, metavar="SECONDS", help="of Cycles (%(default)s)"
    )
    add_judged(table)
    add_environment(table, "cycles", "Blender")

    def run(options: argparse.Namespace) -> None:
        from nightcity.bench.equal_error import EqualErrorOptions, bench_cycles

        chosen = EqualErrorOptions(
            options.camera, options.size, options.pixels, options.error, options.samples,
            options.limit, options.judged, options.environment, options.install,
        )  # fmt: skip
        bench_cycles(options.scene, chosen)

    table.set_defaults(run=run)
