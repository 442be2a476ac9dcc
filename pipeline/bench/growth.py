# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench growth``: what every step costs from small cities to large ones.

Generating, validating and exporting count by processor time, which other work on the machine
hardly changes; load, bake and frame by the renderer's own clock. Memory is that of the largest
process of a step.
"""

from __future__ import annotations

import json
import math
import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from nightcity.bench.cost import run_measured, run_nightcity
from nightcity.bench.growth_picture import draw_growth
from nightcity.bench.growth_record import Growth, LeftOut, read_growth, write_growth
from nightcity.bench.judge import say
from nightcity.errors import NightcityError
from nightcity.render import renderer

_REPEATS = 3
_STAGE = "city"  # and what its layers begin with
FRAMES: Mapping[str, tuple[str, ...]] = {
    "surface": ("--media", "off"),
    "march": ("--model", "paper", "--method", "march"),
    "gauss": ("--model", "paper", "--method", "gauss"),
    "field": ("--model", "single", "--method", "field"),
}


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

    @property
    def kept(self) -> dict[str, object]:
        """What two runs must share to be joined."""
        return {"preset": self.preset, "camera": self.camera, "size": self.size}


def growth(folder: Path, options: GrowthOptions) -> None:
    """Measure every city and write growth.json, .csv, .svg and .png into ``folder``.

    growth.json is written after each step, and a step that it has is not run again.
    """
    folder.mkdir(parents=True, exist_ok=True)
    run = _Run(options, folder, read_growth(folder / "growth.json", options.kept))
    for grid in options.grids:
        if not run.measure(grid):
            break
    found = run.found
    if not found.cities:
        raise NightcityError("; ".join(left.reason for left in found.left_out.values()))
    pictures = draw_growth(found, folder / "growth")
    _print(found, options)
    for path in (folder / "growth.csv", *pictures):
        print(path)


class _Run:
    """Measures city after city into ``found``."""

    def __init__(self, options: GrowthOptions, folder: Path, found: Growth) -> None:
        self._options, self._folder, self.found = options, folder, found

    def measure(self, grid: int) -> bool:
        """Every step of a city; whether there is one: False where it could not be exported."""
        options, city = self._options, self.found.city(grid)
        work = self._folder / f"{grid}x{grid}"
        stage, scene = work / f"{_STAGE}.usda", work / "scene"
        made = ["generate", "--preset", options.preset, "--grid", f"{grid}x{grid}", "-o", stage]
        steps = {
            "generate": (lambda: _costs(made, options.limit), stage),
            "validate": (lambda: _costs(["validate", stage], options.limit), None),
            "export": (
                lambda: _costs(["export", stage, "-o", scene], options.limit),
                scene / "scene.json",
            ),
        }
        frames = [name for name in options.methods if self._is_wanted(grid, name)]
        if "windows" in city and not frames and not self._is_wanted(grid, "validate"):
            return True
        work.mkdir(exist_ok=True)
        for name, (measure, product) in steps.items():
            if name == "generate" or stage.is_file():
                self._try(grid, name, measure, product)
        there = (scene / "scene.json").is_file()
        if there:
            city |= _sizes(work, scene)
            for name in frames:
                self._try(grid, name, lambda m=name: _frame(scene, m, options, work))
        elif "windows" not in city:
            self.found.cities.remove(city)
        self._keep()
        shutil.rmtree(work)
        return there

    def _is_wanted(self, grid: int, name: str) -> bool:
        left = self.found.left_out.get(name)
        done = any(column.startswith(f"{name} ") for column in self.found.city(grid))
        return not done and not (left and grid >= left.grid)

    def _try(
        self,
        grid: int,
        name: str,
        measure: Callable[[], dict[str, float]],
        product: Path | None = None,
    ) -> None:
        """Add a step's columns, where it is wanted or its product is: an earlier run may have had
        both and lost the product."""
        lost = product is not None and not product.exists()
        left = self.found.left_out.get(name)
        if not self._is_wanted(grid, name) and (not lost or (left and grid >= left.grid)):
            return
        say(f"{grid} x {grid}: {name}")
        try:
            columns = {f"{name} {column}": value for column, value in measure().items()}
            self.found.city(grid).update(columns)
        except NightcityError as error:
            reason = f"{name}: left out from {grid} x {grid} on: {error}"
            self.found.left_out[name] = LeftOut(grid, reason)
            say(reason)
        self._keep()

    def _keep(self) -> None:
        write_growth(self.found, self._folder / "growth.json", self._options.kept)


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
    # Not all that lies there: a run that was killed may have left an image behind.
    files = (path for part in work.glob(f"{_STAGE}.*") for path in (part, *part.rglob("*")))
    stage = sum(path.stat().st_size for path in files if path.is_file())
    return counts | {"stage bytes": stage, "flat scene bytes": flat}


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
    for left in found.left_out.values():
        print(f"\n{left.reason}")
