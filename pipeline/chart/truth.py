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

    def of(self, chosen: NDArray[np.bool_] | NDArray[np.int64]) -> Values:
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
    """The model's image at a third of the shot's size; beauty holds what surfaces send.

    Light on lit surfaces is that of ``gauss``: within 0.3 % of the judge's on 95 of 100 pixels,
    which takes five times as long for it as for the haze. It is looked at, not measured with.
    """
    size = shot.size.judged
    exact = FrameFile.read(kept.image(shot, size, _first_order(model, effort.image_tolerance)))
    if model.surfaces == "lit":
        options = _lit_surfaces(model, effort.image_tolerance)
        lit = FrameFile.read(kept.image(shot, size, options))
        exact = FrameFile(exact.glow + lit.beauty - lit.glow, exact.glow, None)
    if model.scattering == "single":
        return exact
    more = FrameFile.read(kept.image(shot, size, _higher_orders(model, effort.image_samples)))
    return FrameFile(exact.beauty + more.beauty, exact.glow + more.glow, None)


# Another than the settings' 0, so that the noise of their paths is not the truth's.
_SEED = ("--seed", "1")


def _first_order(model: Model, tolerance: float) -> Sequence[str]:
    # Lit surfaces send no light into the haze before the second order.
    first = replace(model, scattering="single", surfaces="dim")
    return (*first.options, "--method", "reference", *_asked(tolerance))


def _lit_surfaces(model: Model, tolerance: float) -> Sequence[str]:
    first = replace(model, scattering="single")
    return (*first.options, "--method", "gauss", *_asked(tolerance))


def _asked(tolerance: float) -> Sequence[str]:
    return ("--tolerance", f"{tolerance:g}")


def _higher_orders(model: Model, samples: int) -> Sequence[str]:
    paths = ("--method", "path", "--orders", "2-", "--samples", str(samples))
    return (*model.options, *paths, *_SEED)
