# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench paper``: the paper's three tables beside ours, and Table 3 on to large cities.

Absolute times of another machine say little: each table is also shown as ratios to its own
standard row, 25 steps on the 4 x 4 city at 75 % of the height, on both sides.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from nightcity.bench.in_turn import InTurn, time_in_turn
from nightcity.bench.methods import SURFACE, field, march
from nightcity.bench.scenes import open_scene
from nightcity.chart.paper_tables import (
    FRAMES_PER_SECOND,
    FRAMES_PER_SECOND_BY_GRID,
    FRAMES_PER_SECOND_BY_HEIGHT,
)
from nightcity.chart.runs import Setting

_CITY = "paper-4x4"
_VIEW = "overview75"
_STEPS, _HEIGHT, _GRID = 25, 75, 4  # what the paper varies one at a time
_FRAMES = 2  # a round


@dataclass(frozen=True)
class PaperOptions:
    """tables: of TABLES. size: of the frames, WIDTHxHEIGHT. grids: beyond the paper's four,
    buildings along a side. tolerance: of field."""

    tables: Sequence[str]
    size: str
    grids: Sequence[int]
    tolerance: float
    rounds: int

    def settings(self, steps: int = _STEPS) -> list[Setting]:
        """The columns of a table, where the marches have so many steps."""
        marches = [march(steps, order) for order in ("steps", "lights")]
        return [*marches, SURFACE, field(self.tolerance)]

    def time(
        self, scene: Path, camera: str, settings: Sequence[Setting], folder: Path, label: str
    ) -> dict[Setting, InTurn]:
        """Every setting in turn."""
        view = ["--camera", camera, "--size", self.size]
        frames = dict.fromkeys(settings, _FRAMES)
        return time_in_turn(scene, view, frames, folder, label, self.rounds)


@dataclass(frozen=True)
class _Row:
    """paper: frames a second, where it states them. timed: the columns."""

    label: str
    paper: int | None
    timed: list[InTurn]


def paper_tables(options: PaperOptions) -> None:
    """Measure and print those asked for."""
    with tempfile.TemporaryDirectory() as name:
        for table in options.tables:
            TABLES[table](options, Path(name))


def _subdivisions(options: PaperOptions, folder: Path) -> None:
    scene = open_scene(_CITY, folder).folder
    columns = {steps: options.settings(steps) for steps in FRAMES_PER_SECOND}
    every = dict.fromkeys(setting for settings in columns.values() for setting in settings)
    timed = options.time(scene, _VIEW, list(every), folder, "Table 1")
    rows = [
        _Row(str(steps), rate, [timed[setting] for setting in columns[steps]])
        for steps, rate in FRAMES_PER_SECOND.items()
    ]
    standard = list(FRAMES_PER_SECOND).index(_STEPS)
    _print("Table 1: steps a segment", "steps", options, rows, standard)


def _coverage(options: PaperOptions, folder: Path) -> None:
    scene = open_scene(_CITY, folder).folder
    rows = []
    for height, rate in FRAMES_PER_SECOND_BY_HEIGHT.items():
        camera, label = f"overview{height}", f"Table 2, {height} %"
        timed = options.time(scene, camera, options.settings(), folder, label)
        rows.append(_Row(f"{height} %", rate, list(timed.values())))
    standard = list(FRAMES_PER_SECOND_BY_HEIGHT).index(_HEIGHT)
    _print("Table 2: share of the screen's height", "height", options, rows, standard)


def _grids(options: PaperOptions, folder: Path) -> None:
    rows = []
    for grid in (*FRAMES_PER_SECOND_BY_GRID, *options.grids):
        scene = open_scene(_CITY, folder, {"grid": (grid, grid)}).folder
        label = f"{grid} x {grid}"
        timed = options.time(scene, _VIEW, options.settings(), folder, f"Table 3, {label}")
        counts = json.loads((scene / "scene.json").read_text())["arrays"]
        windows, boxes = counts["window"]["count"], counts["media_box"]["count"]
        label += f" ({windows:,} windows, {boxes:,} boxes)"
        rows.append(_Row(label, FRAMES_PER_SECOND_BY_GRID.get(grid), list(timed.values())))
    standard = list(FRAMES_PER_SECOND_BY_GRID).index(_GRID)
    _print("Table 3: size of the grid", "grid", options, rows, standard)


TABLES: Mapping[str, Callable[[PaperOptions, Path], None]] = {
    "steps": _subdivisions,
    "coverage": _coverage,
    "grid": _grids,
}


def _print(
    title: str, column: str, options: PaperOptions, rows: Sequence[_Row], standard: int
) -> None:
    """Milliseconds, and in brackets how many times those of the standard row."""
    middle = rows[standard]
    device = middle.timed[0].first.device
    print(
        f"\n{title}; {device}, {options.rounds} x {_FRAMES} frames, "
        f"ms (times the row of {middle.label})\n"
    )
    names = ("march, steps outside", "march, lights outside", "surface frame")
    names += (f"field {options.tolerance:g}",)
    print(f"| {column} | paper | " + " | ".join(names) + " |")
    print("|---|---|" + "---|" * len(names))
    for row in rows:
        cells = [
            f"{one.steady_ms:.1f} ({one.steady_ms / whole.steady_ms:.2f})"
            for one, whole in zip(row.timed, middle.timed, strict=True)
        ]
        paper = f"{1e3 / row.paper:.1f} ({middle.paper / row.paper:.2f})" if row.paper else ""
        print(f"| {row.label} | {paper} | " + " | ".join(cells) + " |", flush=True)
