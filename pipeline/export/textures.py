# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Texture files as sRGB texels, bottom row first."""

from __future__ import annotations

import contextlib
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import OpenImageIO
from numpy.typing import NDArray
from pxr import Ar, Sdf

from nightcity.errors import SceneError


def read_texels(asset: Sdf.AssetPath, space: str, where: str) -> NDArray[np.uint8]:
    """(height, width, 4) uint8, sRGB, bottom row first.

    asset: the file, resolved. space: ``sourceColorSpace`` of UsdUVTexture: auto takes 8-bit
    colours as sRGB and everything else as linear. where: the prim that asks, for errors.
    """
    if not asset.resolvedPath:
        raise SceneError(f"{where}: there is no texture file {asset.path or '(empty name)'}")
    with _on_disk(asset.resolvedPath) as path:
        image = OpenImageIO.ImageBuf(path)
        if image.has_error or not image.read():
            raise SceneError(
                f"{where}: OpenImageIO cannot read the texture {asset.path}: {image.geterror()}"
            )
    spec = image.spec()
    linear = space == "raw" or (
        space != "sRGB" and (spec.format.basetype != OpenImageIO.UINT8 or spec.nchannels < 3)
    )
    pixels = image.get_pixels(OpenImageIO.FLOAT)
    pixels = np.asarray(pixels, dtype=np.float32).reshape(spec.height, spec.width, spec.nchannels)
    colour = pixels[:, :, :3] if spec.nchannels >= 3 else np.repeat(pixels[:, :, :1], 3, axis=2)
    if not np.isfinite(colour).all():
        raise SceneError(f"{where}: the texture {asset.path} holds values that are not finite")
    colour = np.clip(colour, 0.0, 1.0)
    if linear:
        colour = _srgb_from_linear(colour)
    texels = np.full((spec.height, spec.width, 4), 255, dtype=np.uint8)
    texels[:, :, :3] = np.rint(colour * 255)
    return texels[::-1]


@contextlib.contextmanager
def _on_disk(path: str) -> Iterator[str]:
    """A file that OpenImageIO can open; one inside a package (.usdz) is unpacked for a while."""
    if not Ar.IsPackageRelativePath(path):
        yield path
        return
    content = Ar.GetResolver().OpenAsset(Ar.ResolvedPath(path)).GetBuffer()
    suffix = Path(Ar.SplitPackageRelativePathInner(path)[1]).suffix
    with tempfile.NamedTemporaryFile(suffix=suffix) as file:
        file.write(content)
        file.flush()
        yield file.name


def linear_from_srgb(colour: NDArray[np.float64]) -> NDArray[np.float64]:
    """Decode sRGB values in 0 to 1 (IEC 61966-2-1)."""
    return np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)


def _srgb_from_linear(colour: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.where(colour <= 0.0031308, 12.92 * colour, 1.055 * colour ** (1 / 2.4) - 0.055)
