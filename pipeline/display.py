# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Images as people see them: EXR through the renderer's tone map, PNG and JPEG as they are."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO
from numpy.typing import NDArray

from nightcity.errors import SceneError


def read_display(path: Path, exposure: float) -> NDArray[np.float32]:
    """Pixels (height, width, 3) in sRGB, 0 to 1. ``exposure``: of EXR, in EV. Raises SceneError."""
    image = OpenImageIO.ImageInput.open(str(path))
    if image is None:
        raise SceneError(f"{path}: is no image that can be read: {OpenImageIO.geterror()}")
    names = list(image.spec().channelnames)
    pixels = image.read_image("float")
    message = image.geterror()
    image.close()
    if pixels is None or not {"R", "G", "B"} <= set(names):
        raise SceneError(f"{path}: is no whole image with R, G and B: {message}")
    colours = pixels[..., [names.index(c) for c in "RGB"]]
    return tone_map(colours, exposure) if path.suffix.lower() == ".exr" else colours


def tone_map(radiance: NDArray[np.float32], exposure: float) -> NDArray[np.float32]:
    """sRGB of radiance (..., 3) times 2^exposure, as renderer/output/tone_map.cpp has it.

    Khronos 2024, PBR Neutral (github.com/KhronosGroup/ToneMapping), then IEC 61966-2-1.
    """
    colour = np.clip(radiance * np.float32(2) ** np.float32(exposure), 0, 1e6)
    lowest = colour.min(axis=-1, keepdims=True)
    colour = colour - np.where(lowest < 0.08, lowest - 6.25 * lowest * lowest, 0.04)
    start, desaturation = 0.8 - 0.04, 0.15
    peak = colour.max(axis=-1, keepdims=True)
    rest = 1 - start
    new_peak = 1 - rest * rest / (np.maximum(peak, start) + rest - start)
    grey = 1 - 1 / (desaturation * (np.maximum(peak, start) - new_peak) + 1)
    rolled = colour * (new_peak / np.maximum(peak, start))
    mapped = np.where(peak < start, colour, rolled + (new_peak - rolled) * grey)
    mapped = np.clip(mapped, 0, 1)
    srgb = np.where(mapped <= 0.0031308, 12.92 * mapped, 1.055 * mapped ** (1 / 2.4) - 0.055)
    return srgb.astype(np.float32)
