# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What a scene needs: what each switch of the model changes in it, and the cheapest setting that
meets a tolerance.

A setting meets a tolerance where 95 of 100 pixels lie within it. It is chosen on one half of the
pixels and held against the other, which the choice has not seen.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.errors import LUMINANCE, relative_errors
from nightcity.chart.measure import Measured, ShotResults
from nightcity.chart.settings import (
    FULL,
    ISOTROPIC,
    LAMBERTIAN,
    MULTIPLE,
    PAPER,
    SINGLE,
    UNOCCLUDED,
    Model,
)
from nightcity.chart.truth import Values

TOLERANCES = (0.1, 0.02, 0.005)
PERCENTILE = 95
_RESAMPLED = 400
_MOST_PATHS = 1_000_000  # that a look at a foretold setting may take
SAFETY = 1.3  # more paths than the noise of few pixels asks for


@dataclass(frozen=True)
class Switch:
    """``poorer`` instead of ``richer``, in words."""

    words: str
    poorer: Model
    richer: Model


SWITCHES = (
    Switch("all windows instead of the paper's lists", PAPER, UNOCCLUDED),
    Switch("visibility", UNOCCLUDED, ISOTROPIC),
    Switch("Lambertian windows instead of isotropic ones", ISOTROPIC, LAMBERTIAN),
    Switch("panes instead of points", LAMBERTIAN, SINGLE),
    Switch("multiple scattering", SINGLE, MULTIPLE),
    Switch("lit surfaces", MULTIPLE, FULL),
)


@dataclass(frozen=True)
class Change:
    """What leaving out a switch's richer side does.

    bias: of the mean, with the half-width of its 95 % interval; p95: of the pixels' errors; beyond:
    share of pixels off by more than 2 %. cost: time of the richer side to the poorer's by the
    cheapest settings that are within 2 % of their own model; None where either has none.
    """

    switch: Switch
    bias: float
    interval: float
    p95: float
    beyond: float
    cost: float | None


@dataclass(frozen=True)
class Recommendation:
    """For one tolerance against one model: the cheapest setting, or what paths would take.

    chosen: None where no charted setting meets the tolerance. error: at the pixels that the choice
    has not seen; None where that was not rendered. cheaper: settings that meet it there at less
    cost, beyond the noise.
    samples, frame_ms: of path, as far as its noise foretells them; None where a setting is chosen
    and where the chart holds no paths of the model.
    """

    tolerance: float
    model: Model
    chosen: Measured | None
    error: float | None
    cheaper: tuple[str, ...]
    samples: int | None
    frame_ms: float | None
    truth_noise: float

    @property
    def options(self) -> tuple[str, ...]:
        """For nightcity render; empty where nothing is known that meets the tolerance."""
        if self.chosen:
            point = self.chosen.point
            return (*point.model.options, "--method", point.method, *point.knobs)
        if self.samples:
            return (*self.model.options, "--method", "path", "--samples", str(self.samples))
        if self.model.scattering == "single":
            return (*self.model.options, "--method", "gauss", "--tolerance", f"{self.tolerance:g}")
        return ()


@dataclass(frozen=True)
class Needs:
    """All that a shot's chart says of the scene."""

    changes: tuple[Change, ...]
    recommendations: tuple[Recommendation, ...]


# Glow (N, 3) of pixels (N, 2) of the shot with these renderer options.
Render = Callable[[NDArray[np.int64], Sequence[str]], NDArray[np.float64]]


def find_needs(
    results: ShotResults, render: Render, tolerances: Sequence[float] = TOLERANCES
) -> Needs:
    """Against the full model, and against single scattering for who accepts to leave out more.

    Paths that no setting of the chart holds are rendered at unseen pixels, where that is cheap.
    """
    found = [recommend(results, tol, model) for model in (FULL, SINGLE) for tol in tolerances]
    return Needs(
        tuple(_change(results, switch) for switch in SWITCHES),
        tuple(_rendered(each, results, render) for each in found),
    )


def _rendered(found: Recommendation, results: ShotResults, render: Render) -> Recommendation:
    unseen = _halves(results)[1]
    if not found.samples or found.samples * int(unseen.sum()) > _MOST_PATHS:
        return found
    glow = render(results.pixels[unseen], found.options)
    errors = relative_errors(glow, results.centres[found.model.name].of(unseen).glow)
    return replace(found, error=float(np.percentile(errors, PERCENTILE)))


def _change(results: ShotResults, switch: Switch) -> Change:
    poorer, richer = (results.centres[model.name] for model in (switch.poorer, switch.richer))
    errors = relative_errors(poorer.glow, richer.glow)
    bias, interval = _bias(poorer, richer)
    costs = [_cheapest_ms(results, model) for model in (switch.richer, switch.poorer)]
    return Change(
        *(switch, bias, interval, float(np.percentile(errors, PERCENTILE))),
        beyond=float(np.mean(errors > 0.02)),
        cost=costs[0] / costs[1] if costs[0] and costs[1] else None,
    )


def _bias(value: Values, truth: Values) -> tuple[float, float]:
    """Of the mean, and the half-width of its 95 % interval: other pixels, other paths."""
    pairs = np.stack([value.glow @ LUMINANCE, truth.glow @ LUMINANCE], axis=1)
    random = np.random.default_rng(0)
    drawn = pairs[random.integers(len(pairs), size=(_RESAMPLED, len(pairs)))].sum(axis=1)
    total = pairs.sum(axis=0)
    if total[1] <= 0:
        return 0.0, 0.0
    spread = np.std(drawn[:, 0] / drawn[:, 1])
    paths = math.hypot(*(math.sqrt(np.sum((v.error @ LUMINANCE) ** 2)) for v in (value, truth)))
    return float(total[0] / total[1] - 1), float(1.96 * math.hypot(spread, paths / total[1]))


def _cheapest_ms(results: ShotResults, model: Model) -> float | None:
    times = [
        measured.steady_ms
        for measured in _charted(results)
        if measured.point.model == model
        and np.percentile(_errors(results, measured, model, _every(results)), PERCENTILE) <= 0.02
    ]
    return min(times, default=None)


def _charted(results: ShotResults) -> list[Measured]:
    return [measured for measured in results.settings if measured.frame is not None]


def _every(results: ShotResults) -> NDArray[np.bool_]:
    return np.ones(len(results.pixels), dtype=bool)


def _halves(results: ShotResults) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    seen = np.zeros(len(results.pixels), dtype=bool)
    order = np.random.default_rng(1).permutation(len(seen))
    seen[order[: (len(seen) + 1) // 2]] = True
    return seen, ~seen


def _errors(
    results: ShotResults, measured: Measured, model: Model, part: NDArray[np.bool_]
) -> NDArray[np.float64]:
    assert measured.frame is not None
    glow = measured.frame.at(results.pixels[part])[0]
    return relative_errors(glow, results.centres[model.name].of(part).glow)


def recommend(results: ShotResults, tolerance: float, model: Model) -> Recommendation:
    """The cheapest setting of the chart whose error against ``model`` is within ``tolerance``."""
    seen, unseen = _halves(results)

    def meets(measured: Measured, part: NDArray[np.bool_], percentile: float) -> bool:
        errors = _errors(results, measured, model, part)
        return float(np.percentile(errors, percentile)) <= tolerance

    noise = results.centres[model.name].noise
    surely = _upper_percentile(int(seen.sum()))
    good = [measured for measured in _charted(results) if meets(measured, seen, surely)]
    if not good:
        return _by_paths(results, tolerance, model, seen, noise)
    chosen = min(good, key=lambda measured: measured.steady_ms)
    cheaper = tuple(
        other.point.name
        for other in _charted(results)
        if meets(other, unseen, PERCENTILE) and _beyond_noise(other, chosen)
    )
    error = float(np.percentile(_errors(results, chosen, model, unseen), PERCENTILE))
    return Recommendation(tolerance, model, chosen, error, cheaper, None, None, noise)


def _upper_percentile(count: int) -> float:
    """The percentile of ``count`` pixels below which PERCENTILE of all lie, at 95 % confidence."""
    share = PERCENTILE / 100
    return 100 * min(1.0, share + 1.645 * math.sqrt(share * (1 - share) / count))


def _beyond_noise(cheap: Measured, costly: Measured) -> bool:
    """Whether all of one's calls were cheaper, to the surface frame, than all of the other's."""
    return max(cheap.ratios) < min(costly.ratios)


def _by_paths(
    results: ShotResults,
    tolerance: float,
    model: Model,
    seen: NDArray[np.bool_],
    noise: float,
) -> Recommendation:
    """Paths have no error but noise, which falls with the root of their number."""
    known = [m for m in _charted(results) if m.point.method == "path" and m.point.model == model]
    if not known:
        return Recommendation(tolerance, model, None, None, (), None, None, noise)
    most = max(known, key=lambda measured: int(measured.point.knob("--samples") or 0))
    error = float(np.percentile(_errors(results, most, model, seen), PERCENTILE))
    samples = int(most.point.knob("--samples") or 0)
    needed = math.ceil(samples * SAFETY * (error / tolerance) ** 2)
    frame_ms = most.steady_ms * needed / samples
    return Recommendation(tolerance, model, None, None, (), needed, frame_ms, noise)
