# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""How wrong an image is, as one definition for every chart and table."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

# Rec. 709 luminance of linear R, G, B.
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
FLOOR_SHARE = 0.01  # of the median nonzero glow: below it an error counts as absolute


@dataclass(frozen=True)
class ErrorStatistics:
    """Relative errors over the pixels that see a medium; all are shares, not percent.

    bias is of the mean glow, signed; the others are of |value - reference| / max(reference, 1 %
    of the median nonzero reference).
    """

    pixels: int
    bias: float
    median: float
    p95: float
    p99: float
    max: float
    relative_rmse: float


def relative_errors(
    glow: NDArray[np.float64], reference: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Of each pixel (N,), for two (N, 3) arrays of glow, W m^-2 sr^-1."""
    value, truth = glow @ LUMINANCE, reference @ LUMINANCE
    lit = truth[truth > 0]
    floor = FLOOR_SHARE * float(np.median(lit)) if lit.size else 0.0
    return np.abs(value - truth) / np.maximum(np.maximum(truth, floor), np.finfo(float).tiny)


def error_statistics(glow: NDArray[np.float64], reference: NDArray[np.float64]) -> ErrorStatistics:
    """Compare two (N, 3) arrays of glow, W m^-2 sr^-1, of the same pixels; N at least 1."""
    value, truth = glow @ LUMINANCE, reference @ LUMINANCE
    relative = relative_errors(glow, reference)
    mean = float(truth.mean())
    return ErrorStatistics(
        pixels=len(truth),
        bias=float(value.mean() / mean - 1) if mean else 0.0,
        median=float(np.median(relative)),
        p95=float(np.percentile(relative, 95)),
        p99=float(np.percentile(relative, 99)),
        max=float(relative.max()),
        relative_rmse=float(np.sqrt(np.mean(relative**2))),
    )
