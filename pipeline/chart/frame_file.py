# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A rendered EXR as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import OpenImageIO
from numpy.typing import NDArray

from nightcity.chart.shot import STRIDE
from nightcity.errors import SceneError


@dataclass(frozen=True)
class FrameFile:
    """Beauty and glow (height, width, 3), W m^-2 sr^-1; of Monte Carlo, glow's standard error."""

    beauty: NDArray[np.float64]
    glow: NDArray[np.float64]
    glow_error: NDArray[np.float64] | None

    @staticmethod
    def read(path: Path) -> FrameFile:
        """Of an image with the channels beauty and glow; raises SceneError."""
        image = OpenImageIO.ImageInput.open(str(path))
        if image is None:
            raise SceneError(f"{path}: is no image that can be read: {OpenImageIO.geterror()}")
        names = list(image.spec().channelnames)
        values = image.read_image("float")
        image.close()
        if values is None or not {"R", "glow.R"} <= set(names):
            raise SceneError(f"{path}: is no whole image with beauty and glow; remove it")

        def channels(prefix: str) -> NDArray[np.float64]:
            return values[..., [names.index(f"{prefix}{c}") for c in "RGB"]].astype(np.float64)

        error = channels("glowError.") if "glowError.R" in names else None
        return FrameFile(channels(""), channels("glow."), error)

    def thinned(self) -> FrameFile:
        """Every third pixel of every third row: those that the judge sees at a third the size."""
        part = slice(STRIDE // 2, None, STRIDE)
        error = None if self.glow_error is None else self.glow_error[part, part]
        return FrameFile(self.beauty[part, part], self.glow[part, part], error)

    def at(self, pixels: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Glow (N, 3) of (N, 2) pixels x, y, and its standard error, 0 where none is known."""
        x, y = pixels[:, 0], pixels[:, 1]
        glow = self.glow[y, x]
        return glow, np.zeros_like(glow) if self.glow_error is None else self.glow_error[y, x]
