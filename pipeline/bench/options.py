# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Options that the tables of ``nightcity bench`` share, and how their texts are read."""

from __future__ import annotations

import argparse
from pathlib import Path

from nightcity.errors import UsageError


def add_scenes(table: argparse.ArgumentParser, usual: str) -> None:
    """Scenes by name or path, and towns."""
    table.add_argument(
        "scene",
        nargs="*",
        metavar="SCENE",
        help=f"presets, stages or folders of flat scenes (default: {usual})",
    )
    table.add_argument("--town", type=Path, action="append", default=[], help="a CityJSON file")


def add_views(table: argparse.ArgumentParser) -> None:
    """Cameras, size, and where the judge keeps its results."""
    table.add_argument(
        "--cameras", type=names, metavar="NAMES", help="(default: overview75,street,far25)"
    )
    table.add_argument("--size", default="1920x1061", metavar="WIDTHxHEIGHT")
    add_judged(table)


def add_judged(table: argparse.ArgumentParser) -> None:
    """Where the judge keeps its results."""
    table.add_argument(
        "--judged",
        type=Path,
        metavar="FOLDER",
        help="keep the judge's results here, and take those that are there (default: not kept)",
    )


def add_environment(table: argparse.ArgumentParser, folder: str, what: str) -> None:
    """Where another renderer is, by default in build/FOLDER, and whether to put it there."""
    table.add_argument(
        "--environment",
        type=Path,
        default=Path("build") / folder,
        metavar="FOLDER",
        help=f"where {what} lives (default: %(default)s)",
    )
    table.add_argument("--install", action="store_true", help=f"install {what} there first")


def names(text: str) -> list[str]:
    """``a,b``."""
    return [name for name in text.split(",") if name]


def numbers(text: str) -> list[float]:
    """``0.01,0.001``."""
    return [number(part) for part in text.split(",")]


def wholes(text: str) -> list[int]:
    """``4,8``: whole numbers from 1 on, ascending and without doubles."""
    try:
        found = sorted({int(part) for part in text.split(",")})
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is no list of whole numbers") from None
    if found[0] < 1:
        raise argparse.ArgumentTypeError(f"{found[0]} is below 1")
    return found


def number(text: str) -> float:
    """One number."""
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is no number") from None


def judge_tolerance(text: str) -> float | None:
    """A number, or None for auto."""
    return None if text == "auto" else number(text)


def check(option: str, asked: list[str], known: tuple[str, ...]) -> None:
    """UsageError that names those that there are, where others or none are asked for."""
    unknown = [name for name in asked if name not in known]
    if unknown or not asked:
        raise UsageError(f"{option} {','.join(asked)}: there are {', '.join(known)}")
