# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What a sweep is, and how its errors are judged."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.stability.lab import Glow, Lab, Shot
from nightcity.chart.stability.methods import Method, NotAskedError
from nightcity.errors import NightcityError

FloatArray = NDArray[np.float64]

# Standard errors: of a thousand normal numbers one in about 140 sweeps passes it by chance, and
# the seeds are fixed.
SIGMAS = 4.5
# Why a method of that tolerance misses a stricter bar.
FIELD_TOLERANCE = "its tolerance is 0.01"
# A noisy method whose standard error is above this share says nothing of a point.
MOST_NOISE = 0.1


@dataclass(frozen=True)
class Errors:
    """One value a point of the axis: relative error, and its standard error (0: no noise)."""

    error: FloatArray
    noise: FloatArray

    @property
    def beyond_noise(self) -> FloatArray:
        """The part of the error that noise does not explain."""
        excess = np.maximum(np.abs(self.error) - SIGMAS * self.noise, 0)
        told = (self.noise <= MOST_NOISE) & np.isfinite(self.error)
        return np.where(told, excess, np.inf)

    @property
    def worst(self) -> float:
        """The largest error beyond noise; infinite where a value is no number or all noise."""
        return float(self.beyond_noise.max())


def relative_errors(found: Glow, truth: FloatArray, scale: FloatArray | None = None) -> Errors:
    """Of each frame its worst pixel; ``scale`` (default: the truth) is what errors relate to.

    Arrays (frames, pixels), or what broadcasts to it. Where the scale is 0, any glow at all is an
    infinite error.
    """
    truth = np.broadcast_to(truth, found.value.shape)
    scale = np.broadcast_to(truth if scale is None else scale, truth.shape)
    difference = found.value - truth
    with np.errstate(divide="ignore", invalid="ignore"):
        error = np.where(difference == 0, 0.0, difference / scale)
        noise = np.where(found.noise == 0, 0.0, found.noise / scale)
    excess = np.abs(error) - SIGMAS * noise
    excess[~np.isfinite(error)] = np.inf
    worst = np.argmax(excess, axis=1)[:, None]
    return Errors(
        np.take_along_axis(error, worst, 1)[:, 0], np.take_along_axis(noise, worst, 1)[:, 0]
    )


def joined(parts: Sequence[Errors]) -> Errors:
    """One after the other, along the axis."""
    return Errors(
        np.concatenate([part.error for part in parts]),
        np.concatenate([part.noise for part in parts]),
    )


@dataclass(frozen=True)
class Axis:
    """What varies. ``quick`` are the points of the tests: some of ``values``, or fewer."""

    label: str  # with the unit
    values: tuple[float, ...]
    quick: tuple[float, ...]
    scale: str = "log"  # of the picture: log, symlog or linear
    names: tuple[str, ...] = ()  # of the values, where they are no measures

    def points(self, quick: bool) -> FloatArray:
        """(n,)."""
        return np.array(self.quick if quick else self.values, float)


@dataclass(frozen=True)
class Failure:
    """A method that is known to fail a sweep: why, and how large its worst error is, at the quick
    points. A worst error outside the range is news. ``least`` is 0 where a mend is awaited."""

    cause: str
    least: float
    most: float


Measure = Callable[[Lab, Method, FloatArray], Errors]


@dataclass(frozen=True)
class Sweep:
    """Errors of every method along one axis, against a truth, with one bar."""

    name: str  # of its files
    title: str
    axis: Axis
    truth: str  # what the errors relate to, in words
    bar: float  # largest relative error of a method that holds
    measure: Measure
    methods: tuple[str, ...] = ("march", "gauss", "field", "path", "reference")
    failures: Mapping[str, Failure] = field(default_factory=dict)
    predicted: Callable[[FloatArray], FloatArray] | None = None  # signed error of the march
    must_notice: bool = False  # from the second point on, errors must be above the bar
    most: Mapping[str, float] = field(default_factory=dict)  # last point asked of a method
    note: str = ""  # for the table


@dataclass(frozen=True)
class Outcome:
    """What a sweep found of one method."""

    sweep: Sweep
    method: str
    points: FloatArray
    errors: Errors
    fault: str = ""  # of a renderer that gave up; the errors are infinite

    @property
    def holds(self) -> bool:
        """Within the bar at every point; planted faults above it."""
        within = self.errors.beyond_noise <= self.sweep.bar
        if self.sweep.must_notice:
            return bool(within[0] and not within[1:].any())
        return bool(within.all())

    @property
    def expected(self) -> bool:
        """As the sweep says: held, or failed by about the known size."""
        failure = self.sweep.failures.get(self.method)
        if failure is None:
            return self.holds
        return failure.least <= self.errors.worst <= failure.most


def run(sweep: Sweep, lab: Lab, method: Method, quick: bool) -> Outcome | None:
    """Measure one sweep with one method; None where it does not know the sweep's physics."""
    points = sweep.axis.points(quick)
    points = points[points <= sweep.most.get(method.name, np.inf)]
    try:
        return Outcome(sweep, method.name, points, sweep.measure(lab, method, points))
    except NotAskedError:
        return None
    except NightcityError as error:
        if error.exit_code != NightcityError.exit_code:  # usage, scene, device: not of the method
            raise
        lost = Errors(np.full(len(points), np.inf), np.zeros(len(points)))
        return Outcome(sweep, method.name, points, lost, str(error))


def against(
    shot_of: Callable[[FloatArray], Shot],
    truth_of: Callable[[FloatArray], FloatArray] | None = None,
    floor: float = 0.0,
) -> Measure:
    """The usual measure: ``shot_of(points)`` has as many frames for every point.

    truth_of: the glow of the points, (n,), or of their frames, (n, frames); without it the judge
    says it, of panes for a method that knows no other windows. floor: glow below which an error
    counts as absolute, W m^-2 sr^-1.
    """

    def measure(lab: Lab, method: Method, points: FloatArray) -> Errors:
        shot = lab.shot(shot_of, points)
        model = method.nearest(shot.model)
        if truth_of is None and model != shot.model:
            shot = replace(shot, model=model)
        found = lab.render(shot, method).by_point(len(points))
        if truth_of is None:
            truth = lab.judge(shot).by_point(len(points)).value
        else:
            truth = np.asarray(truth_of(points), float).reshape(len(points), -1)
        return relative_errors(found, truth, np.maximum(truth, floor))

    return measure
