# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes of USD's implicit surfaces: Cube, Plane and the surfaces of revolution."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from pxr import Usd

from nightcity.errors import SceneError
from nightcity.export.open_stage import Source

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

SEGMENTS = 64  # around an axis: the flat sides lie at most 0.12 % of the radius inside
_RINGS = 32  # from pole to pole of a sphere
# Which coordinate of the profile (x, y across, z along) becomes each axis of the prim: even
# permutations, so that outside stays outside.
_AXES = {"X": [2, 0, 1], "Y": [1, 2, 0], "Z": [0, 1, 2]}

Polygons = tuple[FloatArray, IntArray, IntArray]  # points (V, 3), counts (F,), indices


def implicit_polygons(source: Source, prim: Usd.Prim) -> Polygons | None:
    """Polygons of an implicit surface in the prim's space, counter-clockwise seen from outside;
    None where the type of the prim is not one of them."""
    maker = _MAKERS.get(prim.GetTypeName())
    return None if maker is None else maker(_Sizes(source, prim))


class _Sizes:
    """Reads the sizes of one prim, checked."""

    def __init__(self, source: Source, prim: Usd.Prim) -> None:
        self._source, self._prim = source, prim

    def length(self, name: str, smallest: float = 0.0) -> float:
        value = float(self._source.value(self._prim, name))
        if not (np.isfinite(value) and value >= smallest):
            raise SceneError(
                f"{self._prim.GetPath()}.{name} is {value}; it must be finite and not negative"
            )
        return value

    def oriented(self, points: FloatArray) -> FloatArray:
        return points[:, _AXES[str(self._source.value(self._prim, "axis", "Z"))]]


def _cube(sizes: _Sizes) -> Polygons:
    corner = (np.indices((2, 2, 2)).reshape(3, -1).T - 0.5) * sizes.length("size")
    # Corner 4 x + 2 y + z.
    faces = [0, 1, 3, 2, 4, 6, 7, 5, 0, 4, 5, 1, 2, 3, 7, 6, 0, 2, 6, 4, 1, 5, 7, 3]
    return corner, np.full(6, 4), np.array(faces)


def _plane(sizes: _Sizes) -> Polygons:
    x, y = 0.5 * sizes.length("width"), 0.5 * sizes.length("length")
    points = np.array([[-x, -y, 0], [x, -y, 0], [x, y, 0], [-x, y, 0]])
    return sizes.oriented(points), np.array([4]), np.arange(4)


def _sphere(sizes: _Sizes) -> Polygons:
    radius = sizes.length("radius")
    return _revolve(_arc(radius, -90, 90, 0.0))


def _cone(sizes: _Sizes) -> Polygons:
    radius, half = sizes.length("radius"), 0.5 * sizes.length("height")
    points, counts, indices = _revolve([(0, -half), (radius, -half), (0, half)])
    return sizes.oriented(points), counts, indices


def _cylinder(sizes: _Sizes) -> Polygons:
    bottom, top = _radii(sizes)
    half = 0.5 * sizes.length("height")
    points, counts, indices = _revolve([(0, -half), (bottom, -half), (top, half), (0, half)])
    return sizes.oriented(points), counts, indices


def _capsule(sizes: _Sizes) -> Polygons:
    bottom, top = _radii(sizes)
    half = 0.5 * sizes.length("height")
    profile = [*_arc(bottom, -90, 0, -half), *_arc(top, 0, 90, half)]
    points, counts, indices = _revolve(profile)
    return sizes.oriented(points), counts, indices


def _radii(sizes: _Sizes) -> tuple[float, float]:
    """Bottom and top; Cylinder_1 and Capsule_1 have two."""
    if sizes._prim.GetAttribute("radiusBottom"):
        return sizes.length("radiusBottom"), sizes.length("radiusTop")
    return (sizes.length("radius"),) * 2


def _arc(radius: float, first: float, last: float, centre: float) -> list[tuple[float, float]]:
    """Profile of a sphere about height ``centre`` between two latitudes in degrees."""
    steps = round(_RINGS * (last - first) / 180) + 1
    angles = np.radians(np.linspace(first, last, steps))
    return [(abs(radius * np.cos(a)), centre + radius * np.sin(a)) for a in angles]


def _revolve(profile: Sequence[tuple[float, float]]) -> Polygons:
    """The surface that a profile of (radius, height), from bottom to top, makes about z."""
    angle = 2 * np.pi * np.arange(SEGMENTS) / SEGMENTS
    radius, height = np.array(profile, dtype=np.float64).T
    points = np.stack(
        [
            np.outer(radius, np.cos(angle)),
            np.outer(radius, np.sin(angle)),
            np.repeat(height[:, None], SEGMENTS, axis=1),
        ],
        axis=-1,
    ).reshape(-1, 3)
    lower = SEGMENTS * np.arange(len(profile) - 1)[:, None]
    here, after = np.arange(SEGMENTS), (np.arange(SEGMENTS) + 1) % SEGMENTS
    upper = lower + SEGMENTS
    quads = np.stack([lower + here, lower + after, upper + after, upper + here], axis=-1)
    quads = quads.reshape(-1, 4)
    return points, np.full(len(quads), 4), quads.reshape(-1)


_MAKERS = {
    "Cube": _cube,
    "Plane": _plane,
    "Sphere": _sphere,
    "Cone": _cone,
    "Cylinder": _cylinder,
    "Cylinder_1": _cylinder,
    "Capsule": _capsule,
    "Capsule_1": _capsule,
}
