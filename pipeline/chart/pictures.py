# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures for the page: what a setting renders, what the judge says, and where they differ."""

from __future__ import annotations

import base64
import io

import matplotlib
import numpy as np
from matplotlib import image
from numpy.typing import NDArray

from nightcity.chart.errors import LUMINANCE, relative_errors
from nightcity.chart.flip import exposure
from nightcity.chart.frame_file import FrameFile
from nightcity.display import tone_map

# Errors from the first to the last of these shares run through the colours, by their logarithm.
SCALE = (0.001, 0.01, 0.1, 1.0)
_COLOURS = matplotlib.colormaps["inferno"]
_NO_GLOW = (0.25, 0.28, 0.32)


def picture(shown: FrameFile, truth: FrameFile) -> str:
    """A frame's beauty as a data URI, at the exposure that fits the truth."""
    return _data_uri(tone_map(shown.beauty.astype(np.float32), exposure(truth)))


def error_map(shown: FrameFile, truth: FrameFile) -> str:
    """The relative error of each pixel's glow as a data URI; grey where the truth has none."""
    reference = truth.glow.reshape(-1, 3)
    errors = relative_errors(shown.glow.reshape(-1, 3), reference)
    place = np.log(np.maximum(errors, SCALE[0]) / SCALE[0]) / np.log(SCALE[-1] / SCALE[0])
    colours = _COLOURS(np.clip(place, 0, 1))[:, :3]
    colours[reference @ LUMINANCE <= 0] = _NO_GLOW
    return _data_uri(colours.reshape(truth.glow.shape).astype(np.float32))


def colour_scale() -> dict[str, object]:
    """The scale of the error maps: CSS colours from left to right, and marks at percents of it."""
    colours = [
        "#" + "".join(f"{round(255 * c):02x}" for c in _COLOURS(x)[:3])
        for x in np.linspace(0, 1, 9)
    ]
    marks = [(f"{100 * share:g} %", 100 * i / (len(SCALE) - 1)) for i, share in enumerate(SCALE)]
    return {"colours": colours, "marks": marks}


def _data_uri(pixels: NDArray[np.float32]) -> str:
    file = io.BytesIO()
    image.imsave(file, pixels, format="png", metadata={"Software": None})
    return "data:image/png;base64," + base64.b64encode(file.getvalue()).decode()
