# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What people see of a difference: FLIP (Andersson et al. 2020), after one tone map for both."""

from __future__ import annotations

import flip_evaluator
import numpy as np

from nightcity.chart.frame_file import FrameFile
from nightcity.display import tone_map

_BRIGHT_GLOW = 0.4  # the value that the brightest tenth of the haze gets before the tone map


def exposure(truth: FrameFile) -> float:
    """EV that shows the truth's glow well, windows too bright; 0 where there is no glow."""
    glow = truth.glow.max(axis=-1)
    lit = glow[glow > 0]
    return float(np.log2(_BRIGHT_GLOW / np.percentile(lit, 90))) if lit.size else 0.0


def mean_flip(image: FrameFile, truth: FrameFile) -> float:
    """Mean FLIP of two images of one size, 0 to 1, at FLIP's own viewing distance."""
    stops = exposure(truth)
    shown = [tone_map(each.beauty.astype(np.float32), stops) for each in (truth, image)]
    return float(flip_evaluator.evaluate(*shown, "LDR")[1])
