# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A closer look at a few pixels of a shot than its chart takes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.kept import Kept
from nightcity.chart.runs import PixelTable
from nightcity.chart.settings import Model
from nightcity.chart.shot import Shot
from nightcity.chart.truth import Effort, Values, pixel_truth


@dataclass(frozen=True)
class Look:
    """most: paths that one look may take; effort: what the chart's own truth took."""

    kept: Kept
    shot: Shot
    effort: Effort
    most: int

    def render(self, pixels: NDArray[np.int64], options: Sequence[str]) -> PixelTable:
        """The (N, 2) pixels with these options of the renderer."""
        return self.kept.pixels(self.shot, pixels, options)

    def truth(self, model: Model, pixels: NDArray[np.int64], samples: int) -> Values:
        """What the model says of the (N, 2) pixels; samples: paths of orders from 2 on."""
        effort = replace(self.effort, samples=samples)
        return pixel_truth(self.kept, self.shot, model, pixels, effort)
