# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What a model says when it has converged: the judge's first order, and paths for the others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.errors import LUMINANCE
from nightcity.chart.frame_file import FrameFile
from nightcity.chart.kept import Kept
from nightcity.chart.settings import Model
from nightcity.chart.shot import Shot

INTEGRATED_PLACES = 64  # in a pixel (design section 5)


@dataclass(frozen=True)
class Effort:
    """What the truth may cost.

    tolerance, image_tolerance: of the judge, which is exact to a tenth. samples: paths a pixel for
    the orders that the judge does not know; of an image, image_samples.
    """

    tolerance: float
    samples: int
    image_tolerance: float
    image_samples: int


@dataclass(frozen=True)
class Values:
    """Glow (N, 3), W m^-2 sr^-1, and its standard error (N, 3); 0 where nothing is random."""

    glow: NDArray[np.float64]
    error: NDArray[np.float64]

    def of(self, chosen: NDArray[np.bool_]) -> Values:
        """Those pixels alone."""
        return Values(self.glow[chosen], self.error[chosen])

    @property
    def noise(self) -> float:
        """The median pixel's standard error, relative."""
        glow = np.maximum(self.glow @ LUMINANCE, np.finfo(float).tiny)
        return float(np.median(self.error @ LUMINANCE / glow))


def pixel_truth(
    kept: Kept, shot: Shot, model: Model, pixels: NDArray[np.int64], effort: Effort, places: int = 1
) -> Values:
    """The model's glow of the (N, 2) pixels: at their centres, or the mean over ``places``."""
    sampling = ("--pixel-samples", str(places)) if places > 1 else ()
    exact = kept.pixels(shot, pixels, (*_first_order(model, effort.tolerance), *sampling))
    if model.scattering == "single":
        return Values(exact.glow, np.zeros_like(exact.glow))
    samples = max(effort.samples // places, 2)
    more = kept.pixels(shot, pixels, (*_higher_orders(model, samples), *sampling))
    assert more.glow_error is not None  # Monte Carlo always states it
    return Values(exact.glow + more.glow, more.glow_error)


def image_truth(kept: Kept, shot: Shot, model: Model, effort: Effort) -> FrameFile:
    """The model's image at a third of the shot's size; beauty holds what surfaces send."""
    options = _first_order(model, effort.image_tolerance)
    exact = FrameFile.read(kept.image(shot, shot.size.judged, options))
    if model.scattering == "single":
        return exact
    options = _higher_orders(model, effort.image_samples)
    more = FrameFile.read(kept.image(shot, shot.size.judged, options))
    return FrameFile(exact.beauty + more.beauty, exact.glow + more.glow, None)


def _first_order(model: Model, tolerance: float) -> Sequence[str]:
    single = replace(model, scattering="single")
    return (*single.options, "--method", "reference", "--tolerance", f"{tolerance:g}")


def _higher_orders(model: Model, samples: int) -> Sequence[str]:
    return (*model.options, "--method", "path", "--orders", "2-", "--samples", str(samples))
