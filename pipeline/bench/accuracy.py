# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench accuracy``: every method against the judge, on pixels chosen at random.

The errors are numerical (design section 5): the judge computes the same model. What has a
tolerance is held against it; Monte Carlo is held against its own standard error, and the field's
estimate of its error against that error. Orders of scattering that the judge does not know are
those of paths with another seed; their noise is stated beside the field's error.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nightcity.bench.judge import Keeper, View, choose_pixels, measure, say
from nightcity.bench.scenes import MeasuredScene, open_scene, open_town
from nightcity.chart.agreement import agreement, beyond_bound
from nightcity.chart.errors import ErrorStatistics, error_statistics, relative_errors
from nightcity.chart.runs import PixelTable
from nightcity.errors import UsageError

METHODS = ("gauss", "field", "reference", "path")  # with a tolerance, and Monte Carlo
EMITTERS = ("isotropic", "lambertian", "pane")
PIXELS_FOR_P99 = 1000
_GREEN = 1  # the channels of a window rise and fall together: one of them tells of the noise
_MORE_PATHS = 32  # of a second look
# An error estimate is good when it is exceeded in at most this share of the pixels, and its median
# is at most so many times the median error.
_MOST_EXCEEDED = 0.01
_MOST_CAUTION = 10
_HEADER = (
    "| scene | camera | windows | method | pixels | bias | median | p95 | p99 | max "
    "| relative RMSE | verdict |\n|---|---|---|---|---|---|---|---|---|---|---|---|"
)


@dataclass(frozen=True)
class AccuracyOptions:
    """What is compared. tolerances: largest relative error allowed, each in (0, 1]."""

    methods: Sequence[str]
    tolerances: Sequence[float]
    emitters: Sequence[str]
    cameras: Sequence[str] | None  # none: the usual ones of each scene
    lights: str
    visibility: str
    size: str
    pixels: int
    town_pixels: int
    scattering: str
    surfaces: str
    samples: int  # of path, or where scattering is multiple of the truth
    judge_tolerance: float | None  # none: as auto_judge_tolerance has it
    kept: Path | None  # where the judge's results stay; none: nowhere

    def __post_init__(self) -> None:
        if self.pixels < 1 or self.town_pixels < 1:
            raise UsageError("--pixels and --town-pixels: give at least 1")
        if not all(0 < tolerance <= 1 for tolerance in self.tolerances):
            raise UsageError("--tolerances must lie above 0 and at most at 1")
        if self.scattering == "multiple" and set(self.methods) != {"field"}:
            raise UsageError("--scattering multiple is for --methods field: paths are the truth")
        if self.scattering == "single" and self.surfaces == "lit":
            raise UsageError("--surfaces lit changes the glow with --scattering multiple only")

    def model(self, emitter: str) -> list[str]:
        """Renderer options of the judge's model, which is of the first order."""
        model = ["--lights", self.lights, "--visibility", self.visibility]
        return [*model, "--emitter", emitter]

    @property
    def orders(self) -> list[str]:
        """Renderer options of what the judge does not know."""
        return ["--scattering", self.scattering, "--surfaces", self.surfaces]

    def auto_judge_tolerance(self) -> float:
        """What the judge is asked for: it converges to a tenth of that by itself.

        A ``reference`` that is under test itself gets a judge ten times as strict.
        """
        smallest = min(self.tolerances)
        return smallest / 10 if "reference" in self.methods else smallest


@dataclass(frozen=True)
class Line:
    """A method at one setting; ``tolerance`` is None for Monte Carlo."""

    method: str
    name: str
    options: tuple[str, ...]
    tolerance: float | None


def accuracy(sources: Sequence[str], towns: Sequence[Path], options: AccuracyOptions) -> int:
    """Print the table; returns 1 where a line misses its bar, else 0."""
    rows = missed = 0
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        scenes = [(open_scene(source, work), options.pixels) for source in sources]
        scenes += [(open_town(town, work), options.town_pixels) for town in towns]
        cameras = [scene.choose_cameras(options.cameras) for scene, _ in scenes]
        print(_HEADER, flush=True)
        for (scene, count), names in zip(scenes, cameras, strict=True):
            for row, good in _compare_scene(scene, names, count, options, work):
                print(row, flush=True)
                rows += 1
                missed += not good
    print(f"\n{rows - missed} of {rows} lines meet their bar")
    return 1 if missed else 0


def _compare_scene(
    scene: MeasuredScene, cameras: list[str], count: int, options: AccuracyOptions, work: Path
) -> Iterator[tuple[str, bool]]:
    keeper = Keeper(options.kept or work / "judged")
    for camera in cameras:
        view = View(scene, camera, options.size)
        pixels = choose_pixels(view, count, work)
        for emitter in options.emitters:
            model = options.model(emitter)
            # The methods first: what does not work is said before the judge takes minutes.
            measured = []
            for line in _lines(options):
                say(f"{view}: {emitter}, {line.name}")
                asked = [*model, *options.orders, *line.options]
                measured.append((line, measure(view, pixels, asked, work)))
            truth, noise = _truth(view, emitter, pixels, options, keeper, work)
            for line, first in measured:
                found, anew = first, 0
                if line.tolerance is None:
                    found, anew = _second_look(view, model, first, truth, options, work)
                cells, good = compare(line, found, truth)
                if anew:
                    cells[-1] += f" ({anew} pixels anew, {_MORE_PATHS} times the paths)"
                if noise:
                    cells[-1] += f"; the truth's noise {percent(noise)}"
                head = f"| {scene.name} | {camera} | {emitter} | {line.name} |"
                yield f"{head} {' | '.join(cells)} |", good


def _truth(
    view: View,
    emitter: str,
    pixels: NDArray[np.int64],
    options: AccuracyOptions,
    keeper: Keeper,
    work: Path,
) -> tuple[NDArray[np.float64], float]:
    """Glow (N, 3), and the median pixel's relative standard error."""
    model = options.model(emitter)
    tolerance = options.judge_tolerance or options.auto_judge_tolerance()
    judge = [*model, "--method", "reference", "--tolerance", f"{tolerance:g}"]
    glow = keeper.measure(view, pixels, judge, work).glow
    if options.scattering == "single":
        return glow, 0.0
    paths = ["--method", "path", "--orders", "2-", "--samples", str(options.samples)]
    higher = keeper.measure(view, pixels, [*model, *options.orders, *paths, "--seed", "1"], work)
    assert higher.glow_error is not None  # Monte Carlo always states it
    glow = glow + higher.glow
    lit = glow[:, _GREEN] > 0
    if not lit.any():
        return glow, 0.0
    return glow, float(np.median(higher.glow_error[lit, _GREEN] / glow[lit, _GREEN]))


def _second_look(
    view: View,
    model: list[str],
    found: PixelTable,
    truth: NDArray[np.float64],
    options: AccuracyOptions,
    work: Path,
) -> tuple[PixelTable, int]:
    """Monte Carlo whose pixels beyond the bound were taken anew, with more paths of another seed,
    and how many these were.

    Where a ray passes close to a window, few paths bring most of the light: the standard error
    that a pixel finds by itself is then too small, until more paths have met it. A wrong pixel
    stays beyond the bound.
    """
    if found.glow_error is None or not truth.any():
        return found, 0
    beyond = beyond_bound(found.glow[:, _GREEN], found.glow_error[:, _GREEN], truth[:, _GREEN])
    if not beyond.any():
        return found, 0
    say(f"{view}: {beyond.sum()} pixels anew, with {_MORE_PATHS} times the paths")
    more = ("--method", "path", "--samples", str(_MORE_PATHS * options.samples), "--seed", "1")
    again = measure(view, found.pixels[beyond], [*model, *more], work)
    assert again.glow_error is not None  # Monte Carlo always states it
    glow, error = found.glow.copy(), found.glow_error.copy()
    glow[beyond], error[beyond] = again.glow, again.glow_error
    return replace(found, glow=glow, glow_error=error), int(beyond.sum())


def _lines(options: AccuracyOptions) -> list[Line]:
    lines = []
    for method in options.methods:
        if method == "path":
            samples = str(options.samples)
            taken = ("--method", "path", "--samples", samples)
            lines.append(Line(method, f"path, {samples} samples", taken, None))
            continue
        for tolerance in options.tolerances:
            taken = ("--method", method, "--tolerance", f"{tolerance:g}")
            taken += ("--aovs", "glow,error") if method == "field" else ()
            lines.append(Line(method, f"{method} {tolerance:g}", taken, tolerance))
    return lines


def compare(line: Line, found: PixelTable, truth: NDArray[np.float64]) -> tuple[list[str], bool]:
    """The cells after the method's name, and whether the line meets its bar."""
    errors = error_statistics(found.glow, truth)
    cells = [str(errors.pixels)]
    cells += [percent(value) for value in (errors.bias, errors.median, errors.p95)]
    cells += [percent(errors.p99) if errors.pixels >= PIXELS_FOR_P99 else ""]
    cells += [percent(errors.max), percent(errors.relative_rmse)]
    verdict, good = _verdict(line, errors, found, truth)
    return [*cells, verdict], good


def _verdict(
    line: Line, errors: ErrorStatistics, found: PixelTable, truth: NDArray[np.float64]
) -> tuple[str, bool]:
    if not truth.any():
        return "no glow: nothing to judge", False
    if line.tolerance is not None:
        name, worst = ("p95", errors.p95)
        if errors.pixels >= PIXELS_FOR_P99:
            name, worst = ("p99", errors.p99)
        good = worst <= line.tolerance
        relation = "within" if good else "MISSES"
        verdict = f"{name} {relation} {percent(line.tolerance)}"
        if found.estimate is None:
            return verdict, good
        ledger, holds = _ledger(found.estimate, found, truth)
        return f"{verdict}; {ledger}", good and holds
    assert found.glow_error is not None  # Monte Carlo always states it
    agreed = agreement(found.glow[:, _GREEN], found.glow_error[:, _GREEN], truth[:, _GREEN])
    figures = (
        f"mean ratio {agreed.ratio:.5f} ± {agreed.ratio_error:.5f}, "
        f"worst pixel {agreed.worst:.2f} of {agreed.bound:.2f} sigma"
    )
    faults = agreed.faults
    return (f"MISSES ({'; '.join(faults)}): " if faults else "agrees: ") + figures, not faults


def _ledger(
    estimate: NDArray[np.float64], found: PixelTable, truth: NDArray[np.float64]
) -> tuple[str, bool]:
    """How good the estimates of the relative errors are, of pixels that glow."""
    lit = truth.any(axis=1)
    errors, estimates = relative_errors(found.glow, truth)[lit], estimate[lit]
    exceeded = float(np.mean(errors > estimates))
    caution = float(np.median(estimates) / max(np.median(errors), np.finfo(float).tiny))
    good = exceeded <= _MOST_EXCEEDED and caution <= _MOST_CAUTION
    relation = "holds" if good else "MISSES"
    return f"estimate {relation}: exceeded in {percent(exceeded)}, median x {caution:.2g}", good


def percent(share: float) -> str:
    """A share as percent, with two significant digits below 10 %."""
    value = 100 * share
    return f"{value:.1f} %" if abs(value) >= 10 else f"{value:.2g} %"
