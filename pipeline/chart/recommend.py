# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The cheapest setting of a chart that meets a tolerance.

It is chosen on one half of the pixels and held against the other, which the choice has not seen.
Where no setting meets it, paths do: as many as their noise foretells, which are then rendered at
unseen pixels.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.errors import relative_errors
from nightcity.chart.foretell import PERCENTILE, paths_needed, sure_percentile
from nightcity.chart.look import Look
from nightcity.chart.measure import Measured, ShotResults
from nightcity.chart.settings import Model

_FEWEST = 20  # pixels that say something of a percentile of 95
_PILOT = 100  # pixels whose noise foretells that of the others
# Of a look's paths: what the pilot may take, and the truth.
_PILOT_SHARE, _TRUTH_SHARE = 1 / 8, 1 / 4
NOISE_SHARE = 1 / 6  # of the tolerance: less noise of the truth does no harm


@dataclass(frozen=True)
class Recommendation:
    """For one tolerance against one model: the cheapest setting, or what paths would take.

    chosen: None where no charted setting meets the tolerance. error: at so many ``pixels`` that
    the choice has not seen; None where that was not rendered. cheaper: settings that meet it there
    at less cost, beyond the noise. samples, frame_ms: of paths; None where a setting is chosen and
    where the chart holds no paths of the model. truth_noise: of the pixels' truth, its median.
    """

    tolerance: float
    model: Model
    truth_noise: float
    chosen: Measured | None = None
    error: float | None = None
    pixels: int = 0
    cheaper: tuple[str, ...] = ()
    samples: int | None = None
    frame_ms: float | None = None

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


def recommend(results: ShotResults, tolerance: float, model: Model, look: Look) -> Recommendation:
    """The cheapest setting of the chart whose error against ``model`` is within ``tolerance``."""
    seen, unseen = _halves(results)

    def meets(measured: Measured, part: NDArray[np.bool_], percentile: float) -> bool:
        errors = model_errors(results, measured, model, part)
        return float(np.percentile(errors, percentile)) <= tolerance

    found = Recommendation(tolerance, model, results.centres[model.name].noise)
    surely = sure_percentile(int(seen.sum()))
    good = [measured for measured in results.charted if meets(measured, seen, surely)]
    if not good:
        return _by_paths(results, found, look)
    chosen = min(good, key=lambda measured: measured.steady_ms)
    cheaper = tuple(
        other.point.name
        for other in results.charted
        if meets(other, unseen, PERCENTILE) and _beyond_noise(other, chosen)
    )
    error = float(np.percentile(model_errors(results, chosen, model, unseen), PERCENTILE))
    pixels = int(unseen.sum())
    return replace(found, chosen=chosen, error=error, pixels=pixels, cheaper=cheaper)


def model_errors(
    results: ShotResults, measured: Measured, model: Model, part: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """Relative errors of a setting that has a frame against a model, at a part of the pixels."""
    assert measured.frame is not None
    glow = measured.frame.at(results.pixels[part])[0]
    return relative_errors(glow, results.centres[model.name].of(part).glow)


def _halves(results: ShotResults) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    seen = np.zeros(len(results.pixels), dtype=bool)
    order = np.random.default_rng(1).permutation(len(seen))
    seen[order[: (len(seen) + 1) // 2]] = True
    return seen, ~seen


def _beyond_noise(cheap: Measured, costly: Measured) -> bool:
    """Whether all of one's calls were cheaper, to the surface frame, than all of the other's."""
    return max(cheap.ratios) < min(costly.ratios)


def _by_paths(results: ShotResults, found: Recommendation, look: Look) -> Recommendation:
    """Paths have no error but noise, which falls with the root of their number."""
    known = [
        (int(measured.point.knob("--samples") or 0), measured)
        for measured in results.charted
        if measured.point.method == "path" and measured.point.model == found.model
    ]
    seen, _ = _halves(results)
    if not known or not results.centres[found.model.name].of(seen).glow.any():
        return found
    samples, most = max(known, key=lambda pair: pair[0])
    assert most.frame is not None
    truth = results.centres[found.model.name].of(seen).glow
    error = most.frame.at(results.pixels[seen])[1]
    needed = paths_needed(truth, error, samples, found.tolerance)
    needed = _foretold(results, found, needed, look)
    found = replace(found, samples=needed, frame_ms=most.steady_ms * needed / samples)
    return _looked_at(results, found, look)


def _foretold(results: ShotResults, found: Recommendation, guess: int, look: Look) -> int:
    """Better than from the chart's few paths, whose noise has a long tail."""
    first = np.flatnonzero(_halves(results)[0])[:_PILOT]
    samples = min(guess, int(look.most * _PILOT_SHARE) // len(first))
    truth = results.centres[found.model.name].glow[first]
    if samples < 2 or not truth.any():
        return guess
    table = look.render(results.pixels[first], replace(found, samples=samples).options)
    assert table.glow_error is not None  # Monte Carlo always states it
    return paths_needed(truth, table.glow_error, samples, found.tolerance)


def _looked_at(results: ShotResults, found: Recommendation, look: Look) -> Recommendation:
    """Rendered at as many unseen pixels as the look allows; as it is where those are too few."""
    assert found.samples
    sharp = _truth_samples(results, found, look)
    affordable = look.most // found.samples
    if sharp:
        affordable = min(affordable, int(look.most * _TRUTH_SHARE) // sharp)
    unseen = np.flatnonzero(_halves(results)[1])[:affordable]
    if len(unseen) < _FEWEST:
        return found
    if sharp:
        truth = look.truth(found.model, results.pixels[unseen], sharp)
    else:
        truth = results.centres[found.model.name].of(unseen)
    glow = look.render(results.pixels[unseen], found.options).glow
    error = float(np.percentile(relative_errors(glow, truth.glow), PERCENTILE))
    return replace(found, error=error, pixels=len(unseen), truth_noise=truth.noise)


def _truth_samples(results: ShotResults, found: Recommendation, look: Look) -> int:
    """Paths that make the truth's noise small beside the tolerance; 0 where it is."""
    noise = results.centres[found.model.name].noise
    excess = noise / (NOISE_SHARE * found.tolerance)
    return 0 if excess <= 1 else math.ceil(look.effort.samples * excess**2)
