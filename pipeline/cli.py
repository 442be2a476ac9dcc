# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The command line: parses and calls, nothing else. Exit codes as errors.py has them."""

from __future__ import annotations

import argparse
import shlex
import signal
import sys
from pathlib import Path

from nightcity import __version__
from nightcity.command_parser import CommandParser
from nightcity.errors import NightcityError
from nightcity.farm.commands import add_farm


def main(arguments: list[str] | None = None) -> int:
    """Run one command; returns its exit code."""
    options, rest = _parser().parse_known_args(arguments)
    options.renderer_options = rest
    signal.signal(signal.SIGTERM, _stop)
    try:
        return options.run(options) or 0
    except NightcityError as error:
        print(f"nightcity {options.command}: {error}", file=sys.stderr)
        return error.exit_code
    except BrokenPipeError:
        sys.stderr.close()
        return 1
    except OSError as error:
        place = f" ({error.filename})" if error.filename else ""
        reason = error.strerror or error
        print(f"nightcity {options.command}: {reason}{place}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130


def _stop(signal_number: int, frame: object) -> None:
    raise SystemExit(128 + signal_number)


def _parser() -> CommandParser:
    parser = CommandParser(prog="nightcity", description="Renders the glow of a city at night.")
    parser.add_argument("--version", action="version", version=f"nightcity {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for add in (_demo, _generate, _import, _validate, _export, _render, _stitch, _sheet, _movie):
        add(commands)
    for add in (_chart, _bench, add_farm):
        add(commands)
    return parser


def _demo(commands: argparse._SubParsersAction) -> None:
    command = commands.add_parser(
        "demo", help="a paper city and a real town, from parameters to pictures and a chart"
    )
    command.add_argument(
        "-o", "--output", type=Path, default=Path("out/demo"), help="folder (default %(default)s)"
    )
    command.add_argument(
        "--town", type=Path, help="CityJSON file (default: the excerpt of Delft in tests/data)"
    )

    def run(options: argparse.Namespace) -> None:
        from nightcity.demo import demo

        demo(options.output, options.town)

    command.set_defaults(run=run)


def _generate(commands: argparse._SubParsersAction) -> None:
    from nightcity.city.parameters import add_arguments, parameters_from_arguments

    command = commands.add_parser("generate", help="a city from parameters, as a USD stage")
    command.add_argument("-o", "--output", type=Path, required=True, help="the stage, .usda")
    add_arguments(command)

    def run(options: argparse.Namespace) -> None:
        parameters = parameters_from_arguments(options)
        from nightcity.city.generate import generate
        from nightcity.stage.write import write_stage

        _list_files(write_stage(generate(parameters), options.output))

    command.set_defaults(run=run)


def _import(commands: argparse._SubParsersAction) -> None:
    from nightcity.city.town_options import add_arguments, options_from_arguments

    command = commands.add_parser("import", help="a real town from CityJSON, as a USD stage")
    command.add_argument("town", type=Path, help="CityJSON file, version 1.0 to 2.0")
    command.add_argument("-o", "--output", type=Path, required=True, help="the stage, .usda")
    add_arguments(command)

    def run(options: argparse.Namespace) -> None:
        town_options = options_from_arguments(options)
        from nightcity.city.import_town import import_town
        from nightcity.stage.write import write_stage

        city = import_town(options.town, town_options)
        for note in city.notes:
            print(f"note: {note}", file=sys.stderr)
        _list_files(write_stage(city, options.output))

    command.set_defaults(run=run)


def _validate(commands: argparse._SubParsersAction) -> None:
    command = commands.add_parser("validate", help="check any stage against the schemas")
    command.add_argument("stage", type=Path)

    def run(options: argparse.Namespace) -> int:
        from nightcity.stage.validate import validate_stage

        findings = validate_stage(options.stage)
        for finding in findings:
            print(finding)
        errors = sum(finding.severity == "error" for finding in findings)
        print(f"{options.stage}: {errors} errors, {len(findings) - errors} warnings")
        return 3 if errors else 0

    command.set_defaults(run=run)


def _export(commands: argparse._SubParsersAction) -> None:
    command = commands.add_parser("export", help="a stage as a flat scene for the renderer")
    command.add_argument("stage", type=Path)
    command.add_argument("-o", "--output", type=Path, required=True, help="the scene's folder")
    _add_export_arguments(command)

    def run(options: argparse.Namespace) -> None:
        from nightcity.export.export_stage import export_stage

        report = export_stage(
            options.stage, options.output, frames=options.frames, lists=options.lists
        )
        for note in report.notes:
            print(f"note: {note}", file=sys.stderr)
        print(report)

    command.set_defaults(run=run)


def _add_export_arguments(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--lists",
        choices=("recomputed", "authored"),
        default="recomputed",
        help="light lists: made anew where they no longer fit the geometry, or as authored",
    )
    command.add_argument(
        "--frames",
        type=_frame_range,
        metavar="FIRST-LAST",
        help="frames (default: the stage's time codes)",
    )


def _frame_range(text: str) -> tuple[int, int]:
    first, _, last = text.partition("-")
    try:
        frames = int(first), int(last or first)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is no frame range such as 1-10") from None
    if frames[1] < frames[0]:
        raise argparse.ArgumentTypeError(f"'{text}' ends before it begins")
    return frames


def _render(commands: argparse._SubParsersAction) -> None:
    command = commands.add_parser(
        "render",
        help="render a stage or a flat scene",
        description="Exports the stage to a flat scene, then renders it. Every option not named "
        "here goes to nightcity-render; see `nightcity-render --help`.",
    )
    command.add_argument("stage", type=Path, help="a USD stage, or the folder of a flat scene")
    command.add_argument(
        "--scene", type=Path, help="keep the flat scene in this folder (default: not kept)"
    )
    command.add_argument("--lists", choices=("recomputed", "authored"), default="recomputed")
    command.add_argument(
        "--options",
        default="",
        metavar="TEXT",
        help="more options for nightcity-render in one argument, quoted as in a shell",
    )

    def run(options: argparse.Namespace) -> int:
        from nightcity.render import render

        more = [*options.renderer_options, *shlex.split(options.options)]
        return render(options.stage, more, options.scene, options.lists)

    command.set_defaults(run=run, passes_options_on=True)


def _stitch(commands: argparse._SubParsersAction) -> None:
    command = commands.add_parser(
        "stitch",
        help="join the tiles of a frame",
        description="Joins NAME.1of4.exr, NAME.2of4.exr, ... into NAME.exr.",
    )
    command.add_argument("frame", type=Path, help="the frame to write, or frame.####.exr")
    command.add_argument("--frames", help="like 1-10 or 1-10x2,20")
    command.add_argument("--remove-tiles", action="store_true", help="once the frame is whole")

    def run(options: argparse.Namespace) -> None:
        from nightcity.frames import frame_files
        from nightcity.stitch import stitch

        for frame in frame_files(options.frame, options.frames):
            print(stitch(frame, options.remove_tiles), flush=True)

    command.set_defaults(run=run)


def _add_pictures(command: argparse.ArgumentParser, kind: str) -> None:
    command.add_argument("images", type=Path, help="like frame.####.exr; .exr, .png or .jpg")
    command.add_argument("--frames", required=True, help="like 1-10 or 1-10x2,20")
    command.add_argument("-o", "--output", type=Path, required=True, help=kind)
    command.add_argument(
        "--exposure", type=float, default=2, help="of .exr, in EV (default: %(default)s)"
    )


def _sheet(commands: argparse._SubParsersAction) -> None:
    command = commands.add_parser("sheet", help="a contact sheet of rendered frames")
    _add_pictures(command, "the sheet, .png")

    def run(options: argparse.Namespace) -> None:
        from nightcity.frames import frame_files
        from nightcity.preview import contact_sheet

        frames = frame_files(options.images, options.frames)
        print(contact_sheet(frames, options.output, options.exposure))

    command.set_defaults(run=run)


def _movie(commands: argparse._SubParsersAction) -> None:
    command = commands.add_parser("movie", help="a movie of rendered frames")
    _add_pictures(command, "the movie, .mp4")
    command.add_argument(
        "--scene", type=Path, required=True, help="the flat scene, for its frame rate"
    )

    def run(options: argparse.Namespace) -> None:
        from nightcity.frames import frame_files
        from nightcity.preview import movie

        frames = frame_files(options.images, options.frames)
        print(movie(frames, options.output, options.scene, options.exposure))

    command.set_defaults(run=run)


def _chart(commands: argparse._SubParsersAction) -> None:
    from nightcity.chart.command import add_arguments

    add_arguments(
        commands.add_parser(
            "chart", help="speed against accuracy; what a scene needs; where methods break"
        )
    )


def _bench(commands: argparse._SubParsersAction) -> None:
    from nightcity.bench.command import add_arguments

    add_arguments(commands.add_parser("bench", help="tables of time, memory, size and accuracy"))


def _list_files(paths: list[Path]) -> None:
    for path in paths:
        print(path)


if __name__ == "__main__":
    raise SystemExit(main())
