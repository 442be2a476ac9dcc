# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench growth``: what every step costs from small cities to large ones.

Generating, validating and exporting count by processor time, which other work on the machine
hardly changes; load, bake and frame by the renderer's own clock. Memory is that of the largest
process of a step.
"""

from __future__ import annotations

import csv
import json
import math
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from nightcity.bench.cost import run_measured, run_nightcity
from nightcity.bench.growth_picture import draw_growth
from nightcity.bench.judge import say
from nightcity.errors import NightcityError
from nightcity.render import renderer

_REPEATS = 3
FRAMES: Mapping[str, tuple[str, ...]] = {
    "surface": ("--media", "off"),
    "march": ("--model", "paper", "--method", "march"),
    "gauss": ("--model", "paper", "--method", "gauss"),
    "field": ("--model", "single", "--method", "field"),
}
_LARGER_HALF = 3  # a slope needs so many cities; below some size start-up time is all there is


@dataclass(frozen=True)
class GrowthOptions:
    """grids: n of the n x n cities, ascending. preset: what else they are. methods: of FRAMES.
    limit: seconds that a step may take."""

    grids: Sequence[int]
    preset: str
    methods: Sequence[str]
    camera: str
    size: str
    limit: float


@dataclass
class Growth:
    """cities: what each holds and costs by column name, seconds and bytes. left_out: the steps
    that no larger city tries again, with the reason."""

    cities: list[dict[str, float]] = field(default_factory=list)
    left_out: dict[str, str] = field(default_factory=dict)

    def columns(self, ending: str) -> list[str]:
        """Names of the columns that end so, in the order in which they came up."""
        names = dict.fromkeys(name for city in self.cities for name in city)
        return [name for name in names if name.endswith(ending)]

    def series(self, column: str) -> tuple[np.ndarray, np.ndarray]:
        """Windows and values of the cities that have the column."""
        rows = [city for city in self.cities if city.get(column, 0) > 0]
        return (
            np.array([city["windows"] for city in rows], float),
            np.array([city[column] for city in rows], float),
        )

    def slope(self, column: str) -> float:
        """Exponent with which a column follows the number of windows: a line through the larger
        half of the cities, three at least, on logarithmic axes; NaN for fewer."""
        windows, values = self.series(column)
        if len(values) < _LARGER_HALF:
            return math.nan
        last = slice(-max(_LARGER_HALF, (len(values) + 1) // 2), None)
        return float(np.polyfit(np.log(windows[last]), np.log(values[last]), 1)[0])


def growth(folder: Path, options: GrowthOptions) -> None:
    """Measure every city and write growth.csv, growth.svg and growth.png into ``folder``."""
    found = Growth()
    folder.mkdir(parents=True, exist_ok=True)
    for grid in options.grids:
        with tempfile.TemporaryDirectory(dir=folder) as work:
            found.cities.append({"grid": grid})
            _measure_city(found, grid, options, Path(work))
        if "windows" not in found.cities[-1]:
            found.cities.pop()
            break
        _write_table(found, folder / "growth.csv")
    if not found.cities:
        raise NightcityError("; ".join(found.left_out.values()))
    pictures = draw_growth(found, folder / "growth")
    _print(found, options)
    for path in (folder / "growth.csv", *pictures):
        print(path)


def _measure_city(found: Growth, grid: int, options: GrowthOptions, work: Path) -> None:
    stage, scene = work / "city.usda", work / "scene"
    made = ["generate", "--preset", options.preset, "--grid", f"{grid}x{grid}", "-o", stage]
    steps = {
        "generate": made,
        "validate": ["validate", stage],
        "export": ["export", stage, "-o", scene],
    }
    for name, command in steps.items():
        _try(found, grid, name, lambda c=command: _costs(c, options.limit))
    if not (scene / "scene.json").is_file():
        return
    found.cities[-1] |= _sizes(work, scene)
    for method in options.methods:
        _try(found, grid, method, lambda m=method: _frame(scene, m, options, work))


def _try(found: Growth, grid: int, name: str, measure: Callable[[], dict[str, float]]) -> None:
    """Add a step's columns to the last city, unless a smaller one was too large for it."""
    if name in found.left_out:
        return
    say(f"{grid} x {grid}: {name}")
    try:
        found.cities[-1] |= {f"{name} {column}": value for column, value in measure().items()}
    except NightcityError as error:
        found.left_out[name] = f"{name}: left out from {grid} x {grid} on: {error}"
        say(found.left_out[name])


def _costs(command: Sequence[str | Path], limit: float) -> dict[str, float]:
    cost = run_nightcity(command, limit)
    return {"cpu s": cost.cpu_seconds, "wall s": cost.seconds, "memory bytes": cost.memory}


def _sizes(work: Path, scene: Path) -> dict[str, float]:
    manifest = json.loads((scene / "scene.json").read_text())
    counts = {name: manifest["arrays"][array]["count"] for name, array in (
        ("buildings", "building"), ("windows", "window"), ("media_boxes", "media_box"),
        ("triangles", "triangle"), ("light_list_entries", "light_list"),
    )}  # fmt: skip
    flat = sum(path.stat().st_size for path in scene.iterdir())
    everything = sum(path.stat().st_size for path in work.rglob("*") if path.is_file())
    return counts | {"stage bytes": everything - flat, "flat scene bytes": flat}


def _frame(scene: Path, method: str, options: GrowthOptions, work: Path) -> dict[str, float]:
    statistics = work / "statistics.json"
    view = ["--camera", options.camera, "--size", options.size, "--repeat", str(_REPEATS)]
    run_measured(
        [renderer(), scene, *view, *FRAMES[method], "--quiet"]
        + ["-o", work / "frame.exr", "--stats", statistics],
        options.limit,
    )
    measured = json.loads(statistics.read_text())
    timing, memory = measured["timing"], measured["memory"]
    return {
        "load s": timing["load_ms"] / 1e3,
        "bake s": timing["bake_ms"] / 1e3,
        "frame s": timing["steady_frame_ms"] / 1e3,
        "host memory bytes": memory["host_peak_bytes"],
        "device memory bytes": memory["device_bytes"],
    }


def _write_table(found: Growth, path: Path) -> None:
    names = dict.fromkeys(name for city in found.cities for name in city)
    with path.open("w", newline="") as file:
        table = csv.DictWriter(file, list(names), lineterminator="\n")
        table.writeheader()
        table.writerows(found.cities)


def _print(found: Growth, options: GrowthOptions) -> None:
    last = found.cities[-1]
    print(
        f"Growth of {options.preset}, {options.camera}, {options.size}: slope is the exponent of"
        f" the number of windows over the larger half of the cities\n\n"
        f"| step | slope | {last['grid']:.0f} x {last['grid']:.0f}, {last['windows']:,.0f} windows"
        " | a window |\n|---|---|---|---|"
    )
    for ending, unit, scale, small in ((" s", "s", 1, "µs"), (" bytes", "MB", 1e6, "B")):
        for name in found.columns(ending):
            slope, value = found.slope(name), last.get(name, math.nan)
            each = value / last["windows"] * (1e6 if unit == "s" else 1)
            print(
                f"| {name.removesuffix(ending)} | {slope:.2f} | {value / scale:.3g} {unit} "
                f"| {each:.3g} {small} |"
            )
    for reason in found.left_out.values():
        print(f"\n{reason}")
