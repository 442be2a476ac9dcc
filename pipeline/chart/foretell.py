# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""How many paths a pixel meet a tolerance, from the noise of fewer."""

from __future__ import annotations

import math
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.errors import LUMINANCE

PERCENTILE = 95  # of the pixels that must lie within a tolerance
# More paths than the noise asks for: it has a long tail, which few paths do not know.
_SAFETY = 1.6
_MOST = 1 << 24  # that the renderer takes
# What noise of one standard error may come to, as evenly likely values.
_NORMAL = np.array([abs(NormalDist().inv_cdf((i + 0.5) / 40)) for i in range(40)])


def paths_needed(
    glow: NDArray[np.float64], error: NDArray[np.float64], samples: int, tolerance: float
) -> int:
    """For, most likely, 95 of 100 pixels, from some whose glow (N, 3) is known and that ``samples``
    paths render with the standard error (N, 3); at least one of them lit."""
    lit = glow @ LUMINANCE > 0
    sigmas = (error[lit] @ LUMINANCE) / (glow[lit] @ LUMINANCE)
    within = float(np.percentile(np.outer(_NORMAL, sigmas), sure_percentile(len(sigmas))))
    return max(2, min(math.ceil(samples * _SAFETY * (within / tolerance) ** 2), _MOST))


def sure_percentile(count: int) -> float:
    """The percentile of ``count`` pixels below which PERCENTILE of all lie, at 95 % confidence."""
    share = PERCENTILE / 100
    return 100 * min(1.0, share + 1.645 * math.sqrt(share * (1 - share) / count))
