# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The arguments of ``nightcity chart``; imports what they need once they are parsed."""

from __future__ import annotations

import argparse
from pathlib import Path

from nightcity.errors import UsageError


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Speed against accuracy of scenes, or the stability sweeps."""
    command.add_argument(
        "scenes",
        type=Path,
        nargs="*",
        metavar="SCENE",
        help="a USD stage, or the folder of a flat scene",
    )
    command.add_argument("-o", "--output", type=Path, help="the chart's folder")
    command.add_argument(
        "--cameras",
        type=lambda text: text.split(","),
        metavar="NAMES",
        help="separated by commas (default: each scene's first)",
    )
    command.add_argument(
        "--size", metavar="WxH", help="of the timed frames; both sides divide by 3"
    )
    command.add_argument("--quick", action="store_true", help="fewer settings, smaller frames")
    command.add_argument(
        "--stability",
        action="store_true",
        help="instead, the errors of all methods in tiny scenes where methods break",
    )
    command.add_argument(
        "--methods", type=lambda text: text.split(","), metavar="NAMES", help="of --stability"
    )
    command.add_argument(
        "--compare",
        type=Path,
        nargs=2,
        metavar=("OLD.csv", "NEW.csv"),
        help="instead, what became slower or less accurate beyond the noise; exit code 1 if any",
    )
    command.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    if options.compare:
        return _compare(options)
    if options.output is None:
        raise UsageError("-o FOLDER is missing: where the chart shall lie")
    if options.stability:
        if options.scenes or options.cameras or options.size:
            raise UsageError("--stability has scenes, cameras and sizes of its own: name none")
        from nightcity.chart.stability.report import chart_stability

        _list_files(chart_stability(options.output, options.methods, options.quick))
        return 0
    if options.methods or not options.scenes:
        raise UsageError("name a scene to chart, or give --stability, to which --methods belongs")
    from nightcity.chart.speed_accuracy import ChartOptions, chart

    asked = ChartOptions(options.cameras, options.size, options.quick)
    _list_files(chart(options.scenes, options.output, asked))
    return 0


def _compare(options: argparse.Namespace) -> int:
    if options.scenes or options.output or options.stability:
        raise UsageError("--compare reads two tables: name no scene, no -o, no --stability")
    from nightcity.chart.compare import compare

    found = compare(*options.compare)
    for line in found:
        print(line)
    print(f"{len(found)} worse" if found else "nothing is slower or less accurate")
    return 1 if found else 0


def _list_files(paths: list[Path]) -> None:
    for path in paths:
        print(path)
