# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Facade textures: a few procedural ones, or image files.

A texture multiplies the facade's reflectance, so the procedural ones are bright: their largest
values are near white, and their colour is a tint.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import OpenImageIO as oiio  # noqa: N813
from numpy.typing import NDArray

from nightcity.city.model import FloatArray
from nightcity.errors import UsageError

BUILT_IN = ("plain", "concrete", "brick", "glass")
_FILE_TYPES = (".png", ".jpg", ".jpeg")
_TEXELS = 256  # edge of a procedural texture
_LARGEST_EDGE = 8192  # texels of a texture from a file


@dataclass(frozen=True)
class FacadeTexture:
    """name: of its material. texels: as in Material.texture, or None. size: m, of one repeat."""

    name: str
    texels: NDArray[np.uint8] | None
    size: tuple[float, float]


def accept_texture_names(value: object) -> tuple[str, ...]:
    """Names of built-in textures or image files; ValueError for anything else."""
    names = value.split(",") if isinstance(value, str) else value
    if not isinstance(names, list | tuple) or not names:
        raise ValueError("must be a list of names")
    for name in names:
        if not isinstance(name, str) or not name or "\0" in name:
            raise ValueError("must be a list of names")
        if name not in BUILT_IN and not name.lower().endswith(_FILE_TYPES):
            near = difflib.get_close_matches(name, BUILT_IN, n=1, cutoff=0.4)
            raise ValueError(
                f"holds {name!r}, which is neither a built-in texture nor a PNG or JPEG file"
                + (f"; did you mean {near[0]}?" if near else "")
            )
    if len(set(names)) < len(names):
        raise ValueError("names a texture twice")
    return tuple(names)


def facade_textures(names: tuple[str, ...], file_width: float) -> tuple[FacadeTexture, ...]:
    """The textures of these names. file_width: m that the width of an image file covers.

    UsageError names a file that cannot be used.
    """
    textures = []
    for name in names:
        if name in BUILT_IN:
            texels, size = _PROCEDURAL[name]() if name in _PROCEDURAL else (None, (1.0, 1.0))
            textures.append(FacadeTexture(f"facade_{name}", texels, size))
        else:
            texels = _read_image(name)
            height = file_width * texels.shape[0] / texels.shape[1]
            textures.append(FacadeTexture(f"facade_{len(textures)}", texels, (file_width, height)))
    return tuple(textures)


def _read_image(name: str) -> NDArray[np.uint8]:
    """(rows, columns, 3) of an image file, top row first, sRGB as stored."""
    where = f"facade_textures: {name}"
    if not Path(name).is_file():
        raise UsageError(f"{where}: no such file")
    image = oiio.ImageInput.open(name)
    if image is None:
        raise UsageError(f"{where}: {oiio.geterror().strip() or 'is no image'}")
    try:
        spec = image.spec()
        if max(spec.width, spec.height) > _LARGEST_EDGE:
            raise UsageError(f"{where}: is larger than {_LARGEST_EDGE} texels; scale it down")
        texels = image.read_image(0, 0, 0, min(spec.nchannels, 3), "uint8")
        if texels is None or image.has_error:
            raise UsageError(f"{where}: {image.geterror().strip() or 'cannot be read'}")
    finally:
        image.close()
    texels = np.asarray(texels, dtype=np.uint8).reshape(spec.height, spec.width, -1)
    grey = texels.shape[2] < 3  # with or without alpha
    return np.repeat(texels[..., :1], 3, axis=2) if grey else np.ascontiguousarray(texels)


def _concrete() -> tuple[NDArray[np.uint8], tuple[float, float]]:
    """Cast panels of 2.5 m with dark joints, four to a repeat, each a little different."""
    u, v = _texel_centres()
    rng = np.random.default_rng(11)
    panel = 0.86 + 0.1 * rng.random((2, 2))[(v * 2).astype(int), (u * 2).astype(int)]
    joint = np.minimum(_distance_to_line(u * 2), _distance_to_line(v * 2)) < 0.012
    stain = 0.05 * _periodic_noise(rng, 16) + 0.03 * _periodic_noise(rng, 64)
    grey = np.where(joint, 0.55, panel + stain)
    return _texels(grey[..., None] * np.array((1.0, 0.98, 0.94))), (5.0, 5.0)


def _brick() -> tuple[NDArray[np.uint8], tuple[float, float]]:
    """Running bond: 8 bricks of 0.25 m by 16 courses of 0.125 m."""
    u, v = _texel_centres()
    course = (v * 16).astype(int)
    along = (u * 8 + 0.5 * (course % 2)) % 8
    rng = np.random.default_rng(12)
    shade = 0.72 + 0.28 * rng.random((16, 8))[course, along.astype(int)]
    joint = (_distance_to_line(along) < 0.05) | (_distance_to_line(v * 16) < 0.08)
    colour = shade[..., None] * np.array((0.85, 0.37, 0.25))
    colour += 0.04 * _periodic_noise(rng, 64)[..., None]
    return _texels(np.where(joint[..., None], 0.72, colour)), (2.0, 2.0)


def _glass() -> tuple[NDArray[np.uint8], tuple[float, float]]:
    """A curtain wall: panes of 1.25 m by 2.5 m in bright mullions, a spandrel below each."""
    u, v = _texel_centres()
    rng = np.random.default_rng(13)
    pane = 0.35 + 0.12 * rng.random((2, 4))[(v * 2).astype(int), (u * 4).astype(int)]
    spandrel = (v * 2) % 1 > 0.78
    mullion = (_distance_to_line(u * 4) < 0.03) | (_distance_to_line(v * 2) < 0.015)
    colour = np.where(spandrel, 0.3, pane)[..., None] * np.array((0.75, 0.95, 1.1))
    return _texels(np.where(mullion[..., None], 0.8, colour)), (5.0, 5.0)


_PROCEDURAL = {"concrete": _concrete, "brick": _brick, "glass": _glass}


def _texel_centres() -> tuple[FloatArray, FloatArray]:
    centre = (np.arange(_TEXELS) + 0.5) / _TEXELS
    return np.meshgrid(centre, centre)


def _distance_to_line(x: FloatArray) -> FloatArray:
    """Distance to the nearest whole number."""
    return np.abs(x - np.round(x))


def _periodic_noise(rng: np.random.Generator, cells: int) -> FloatArray:
    """Smooth noise from -1 to 1 that repeats with the texture: a lattice of cells x cells."""
    lattice = rng.uniform(-1, 1, (cells, cells))
    place = (np.arange(_TEXELS) + 0.5) / _TEXELS * cells
    low = np.floor(place).astype(int)
    share = place - low
    share = share * share * (3 - 2 * share)
    high = (low + 1) % cells
    rows = lattice[low] * (1 - share[:, None]) + lattice[high] * share[:, None]
    return rows[:, low] * (1 - share) + rows[:, high] * share


def _texels(linear: FloatArray) -> NDArray[np.uint8]:
    """sRGB bytes of linear colours (IEC 61966-2-1)."""
    linear = np.clip(linear, 0, 1)
    encoded = np.where(
        linear <= 0.0031308, 12.92 * linear, 1.055 * np.power(linear, 1 / 2.4) - 0.055
    )
    return np.floor(255 * encoded + 0.5).astype(np.uint8)
