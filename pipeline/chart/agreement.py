# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Whether Monte Carlo agrees with the judge: design section 5's three conditions."""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.errors import FLOOR_SHARE

MEAN_SIGMAS = 3.0
CHANCE = 0.01  # that the worst of all pixels passes the bound by chance
LARGEST_ERROR = 0.005  # of the mean, relative: with more noise, agreement says little


@dataclass(frozen=True)
class Agreement:
    """ratio: of the means, 1 in truth; ratio_error: its standard error. worst: the largest
    |value - truth| of a pixel in its own standard errors; bound: Sidak's for so many pixels."""

    pixels: int
    ratio: float
    ratio_error: float
    worst: float
    bound: float

    @property
    def faults(self) -> list[str]:
        """What does not hold, in words; empty where they agree."""
        faults = []
        if abs(self.ratio - 1) > MEAN_SIGMAS * self.ratio_error:
            sigmas = abs(self.ratio - 1) / self.ratio_error if self.ratio_error else math.inf
            faults.append(f"means {sigmas:.1f} standard errors apart")
        if self.worst > self.bound:
            faults.append("a pixel beyond the bound")
        if self.ratio_error > LARGEST_ERROR:
            faults.append(f"standard error above {100 * LARGEST_ERROR:g} %: take more samples")
        return faults


def agreement(
    value: NDArray[np.float64], error: NDArray[np.float64], truth: NDArray[np.float64]
) -> Agreement:
    """Compare (N,) estimates of standard error ``error`` with the truth; sum of truth above 0.

    Pixels darker than 1 % of the median nonzero truth count in the mean and not one by one: a
    handful of paths that found light says nothing of its own noise.
    """
    sigmas = _sigmas(value, error, truth)
    return Agreement(
        pixels=len(truth),
        ratio=float(value.sum() / truth.sum()),
        ratio_error=float(np.sqrt(np.sum(error**2)) / truth.sum()),
        worst=float(np.nanmax(sigmas)),
        bound=sidak_bound(int(np.sum(~np.isnan(sigmas)))),
    )


def beyond_bound(
    value: NDArray[np.float64], error: NDArray[np.float64], truth: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Which of the (N,) pixels lie farther from the truth than Sidak's bound allows."""
    sigmas = _sigmas(value, error, truth)
    return sigmas > sidak_bound(int(np.sum(~np.isnan(sigmas))))


def _sigmas(
    value: NDArray[np.float64], error: NDArray[np.float64], truth: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Distances (N,) from the truth in standard errors; NaN where a pixel is too dark to count."""
    floor = FLOOR_SHARE * float(np.median(truth[truth > 0]))
    distance = np.abs(value - truth)
    with np.errstate(divide="ignore", invalid="ignore"):
        sigmas = np.where(distance > 0, distance / error, 0.0)
    return np.where(truth >= floor, sigmas, np.nan)


def sidak_bound(count: int) -> float:
    """|z| that the largest of ``count`` independent normal numbers passes with CHANCE."""
    each = -math.expm1(math.log1p(-CHANCE) / count)
    return -NormalDist().inv_cdf(each / 2)
