# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Every setting of a chart, timed in turn and held against what its model and the richest say."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.errors import ErrorStatistics, error_statistics
from nightcity.chart.frame_file import FrameFile
from nightcity.chart.kept import Frame, Kept
from nightcity.chart.runs import Timing
from nightcity.chart.settings import LADDER, RICHEST, SURFACE, Model, Point
from nightcity.chart.shot import Shot
from nightcity.chart.truth import INTEGRATED_PLACES, Effort, Values, image_truth, pixel_truth
from nightcity.errors import NightcityError

KINDS = ("numerical", "total")
PLACES = ("centre", "integrated")
_SURFACE_FRAMES = 5


@dataclass(frozen=True)
class Extent:
    """How much work a chart is: rounds of timed calls, pixels judged at their centre and as means
    over places in them, what the truth may cost, and the paths of a closer look at one setting."""

    size: str
    rounds: int
    pixels: int
    integrated_pixels: int
    effort: Effort
    look_paths: int


QUICK = Extent("300x165", 2, 200, 12, Effort(0.01, 512, 0.1, 32), 100_000)
FULL = Extent("300x165", 2, 1000, 32, Effort(0.003, 1024, 0.1, 64), 8_000_000)


@dataclass(frozen=True)
class Truth:
    """Of one model that is charted: integrated pixels, and an image at a third of the size."""

    integrated: Values
    image: FrameFile


@dataclass
class Measured:
    """A setting of a shot: what its calls took, and what the first of them rendered."""

    point: Point
    timings: list[Timing] = field(default_factory=list)
    ratios: list[float] = field(default_factory=list)  # to the surface frame of the same round
    frame: FrameFile | None = None
    failure: str = ""  # why there are no more calls

    @property
    def steady_ms(self) -> float:
        """The median of its calls."""
        return statistics.median(timing.steady_frame_ms for timing in self.timings)


@dataclass(frozen=True)
class ShotResults:
    """All that was measured of one shot."""

    shot: Shot
    pixels: NDArray[np.int64]
    integrated_pixels: NDArray[np.int64]
    surface: list[Timing]
    settings: list[Measured]
    truths: dict[str, Truth]  # by the model's name
    centres: dict[str, Values]  # of every model of the ladder, by its name

    @property
    def charted(self) -> list[Measured]:
        """The settings that have a frame."""
        return [measured for measured in self.settings if measured.frame is not None]

    def errors(self, measured: Measured, kind: str, place: str) -> ErrorStatistics:
        """Of one kind (KINDS) at one place (PLACES); ``measured`` has a frame."""
        assert measured.frame is not None
        truth = self.truth(measured.point.model if kind == "numerical" else RICHEST, place)
        pixels = self.pixels if place == "centre" else self.integrated_pixels
        return error_statistics(measured.frame.at(pixels)[0], truth.glow)

    def truth(self, model: Model, place: str) -> Values:
        """What the model says at ``place``."""
        centre = place == "centre"
        return self.centres[model.name] if centre else self.truths[model.name].integrated


Advance = Callable[[float], None]


def planned_work(points: Sequence[Point], extent: Extent, shots: int) -> float:
    """What `measure_shot` will have advanced after all shots."""
    each = sum(_work(point) * min(point.rounds, extent.rounds) for point in points)
    return shots * (each + _TRUTH_WORK * (len(_models(points)) + len(LADDER)))


_TRUTH_WORK = 20.0  # in the unit of Point.work


def _work(point: Point) -> float:
    return point.work * point.frames


def _models(points: Sequence[Point]) -> list[Model]:
    return list(dict.fromkeys([*(point.model for point in points), RICHEST]))


def measure_shot(
    kept: Kept, shot: Shot, points: Sequence[Point], extent: Extent, advance: Advance
) -> ShotResults:
    """Time the points round robin, then judge them. What is kept already costs nothing."""
    surface: list[Timing] = []
    settings = [Measured(point) for point in points]
    for part in range(extent.rounds):
        frame = kept.frame(shot, SURFACE, _SURFACE_FRAMES, part, image=False)
        surface.append(frame.timing)
        for measured in settings:
            if part < measured.point.rounds:
                _measure_once(kept, shot, measured, part, frame.timing)
                advance(_work(measured.point))
    chosen = kept.choose_pixels(shot, extent.pixels)
    # An own selection: the pixels come in the order of the rows.
    order = np.random.default_rng(0).permutation(len(chosen))
    integrated = chosen[np.sort(order[: extent.integrated_pixels])]
    effort, centres, truths = extent.effort, {}, {}
    for model in LADDER:
        centres[model.name] = pixel_truth(kept, shot, model, chosen, effort)
        advance(_TRUTH_WORK)
    for model in _models(points):
        truths[model.name] = Truth(
            pixel_truth(kept, shot, model, integrated, effort, INTEGRATED_PLACES),
            image_truth(kept, shot, model, effort),
        )
        advance(_TRUTH_WORK)
    return ShotResults(shot, chosen, integrated, surface, settings, truths, centres)


def _measure_once(kept: Kept, shot: Shot, measured: Measured, part: int, surface: Timing) -> None:
    if measured.failure:
        return
    point = measured.point
    try:
        frame: Frame = kept.frame(shot, point.setting, point.frames, part, image=part == 0)
    except NightcityError as error:
        measured.failure = str(error)
        return
    measured.timings.append(frame.timing)
    measured.ratios.append(frame.timing.steady_frame_ms / surface.steady_frame_ms)
    if frame.image:
        measured.frame = FrameFile.read(frame.image)
