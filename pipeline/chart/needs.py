# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What a scene needs: what each switch of the model changes in it, and the cheapest setting that
meets a tolerance (`recommend`)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.errors import LUMINANCE, relative_errors
from nightcity.chart.foretell import PERCENTILE
from nightcity.chart.look import Look
from nightcity.chart.measure import ShotResults
from nightcity.chart.recommend import Recommendation, recommend
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
from nightcity.chart.switch_cost import Cost, switch_cost
from nightcity.chart.truth import Values

TOLERANCES = (0.1, 0.02, 0.005)
_RESAMPLED = 400


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

    bias: of the mean, with the half-width of its 95 % interval; errors: (N,) of the pixels. cost:
    None where no setting was charted with both sides.
    """

    switch: Switch
    bias: float
    interval: float
    errors: NDArray[np.float64]
    cost: Cost | None

    @property
    def p95(self) -> float:
        """Within which 95 of 100 pixels stay."""
        return float(np.percentile(self.errors, PERCENTILE))

    def beyond(self, tolerance: float) -> float:
        """The share of pixels that are off by more."""
        return float(np.mean(self.errors > tolerance))


@dataclass(frozen=True)
class Needs:
    """All that a shot's chart says of the scene."""

    changes: tuple[Change, ...]
    recommendations: tuple[Recommendation, ...]


def find_needs(results: ShotResults, look: Look, tolerances: Sequence[float] = TOLERANCES) -> Needs:
    """Against the full model, and against single scattering for who accepts to leave out more."""
    return Needs(
        tuple(_change(results, switch) for switch in SWITCHES),
        tuple(
            recommend(results, tolerance, model, look)
            for model in (FULL, SINGLE)
            for tolerance in tolerances
        ),
    )


def _change(results: ShotResults, switch: Switch) -> Change:
    poorer, richer = (results.centres[model.name] for model in (switch.poorer, switch.richer))
    errors = relative_errors(poorer.glow, richer.glow)
    bias, interval = _bias(poorer, richer)
    cost = switch_cost(results, switch.poorer, switch.richer)
    return Change(switch, bias, interval, errors, cost)


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
