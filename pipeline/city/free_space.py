# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Where a town is free: short rays and cover, against all triangles through one spatial index."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import shapely

from nightcity.city.model import BoolArray, FloatArray, IntArray

_BLOCK = 4_000  # rays at a time; bounds the memory of ray-triangle pairs
_EDGE = 1e-9  # barycentric slack, so that no ray slips between two triangles
_UP = np.array((0.0, 0.0, 1.0))


class FreeSpace:
    """All opaque triangles (T, 3, 3) m of a town, without the ground."""

    def __init__(self, corners: FloatArray) -> None:
        self._a = corners[:, 0]
        self._ab = corners[:, 1] - corners[:, 0]
        self._ac = corners[:, 2] - corners[:, 0]
        lo, hi = corners.min(axis=1), corners.max(axis=1)
        self._tree = shapely.STRtree(shapely.box(lo[:, 0], lo[:, 1], hi[:, 0], hi[:, 1]))

    def distances(self, origins: FloatArray, directions: FloatArray, reach: float) -> FloatArray:
        """Distance (N,) m along unit directions (N, 3) to the first triangle; inf beyond reach."""
        nearest = np.full(len(origins), np.inf)
        for ray, _, distance in self._hits(origins, directions, reach):
            np.minimum.at(nearest, ray, distance)
        return nearest

    def covered(self, points: FloatArray) -> BoolArray:
        """(N,) whether points (N, 3) m lie inside a building: more faces above them look up than
        down. That holds too where solids overlap or share faces; eaves and arches, which look
        down and up again, leave the space below them free."""
        surplus = np.zeros(len(points))
        up = np.broadcast_to(_UP, points.shape)
        for ray, triangle, _ in self._hits(points, up, np.inf):
            normal_z = np.cross(self._ab[triangle], self._ac[triangle])[:, 2]
            np.add.at(surplus, ray, np.sign(normal_z))
        return surplus > 0

    def _hits(
        self, origins: FloatArray, directions: FloatArray, reach: float
    ) -> Iterator[tuple[IntArray, IntArray, FloatArray]]:
        """Blocks of (ray, triangle, distance), by Moeller and Trumbore (1997), both sides."""
        for start in range(0, len(origins), _BLOCK):
            block = slice(start, start + _BLOCK)
            ray, triangle = self._candidates(origins[block], directions[block], reach)
            ray = ray + start
            direction = directions[ray]
            p = np.cross(direction, self._ac[triangle])
            determinant = np.einsum("ij,ij->i", self._ab[triangle], p)
            with np.errstate(divide="ignore", invalid="ignore"):  # parallel: fails every test
                inverse = 1.0 / determinant
                s = origins[ray] - self._a[triangle]
                b = np.einsum("ij,ij->i", s, p) * inverse
                q = np.cross(s, self._ab[triangle])
                c = np.einsum("ij,ij->i", direction, q) * inverse
                distance = np.einsum("ij,ij->i", self._ac[triangle], q) * inverse
                hit = (b >= -_EDGE) & (c >= -_EDGE) & (b + c <= 1 + _EDGE)
                hit &= (distance > 0) & (distance <= reach)
            yield ray[hit], triangle[hit], distance[hit]

    def _candidates(
        self, origins: FloatArray, directions: FloatArray, reach: float
    ) -> tuple[IntArray, IntArray]:
        """(ray, triangle) pairs whose bounds in plan touch. Without reach: vertical rays."""
        ends = origins + directions * reach if np.isfinite(reach) else origins
        lo, hi = np.minimum(origins, ends), np.maximum(origins, ends)
        ray, triangle = self._tree.query(shapely.box(lo[:, 0], lo[:, 1], hi[:, 0], hi[:, 1]))
        return ray, triangle
