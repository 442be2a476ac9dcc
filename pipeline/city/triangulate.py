# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Polygons with holes in space -> triangles, each polygon on its own plane (mapbox earcut)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import mapbox_earcut
import numpy as np

from nightcity.city.model import FloatArray, IntArray

SMALLEST_AREA = 1e-6  # m^2; a polygon below it cannot be seen and has no reliable normal
# Earcut's triangles of a sound polygon add up to its area. Real outlines bend out of their plane
# and touch themselves a little; more than this and the outline crosses itself.
_AREA_MISFIT = 0.01


@dataclass(frozen=True)
class Triangles:
    """vertices: (T, 3) into the points, wound as their polygon. polygon: (T,) whose they are."""

    vertices: IntArray
    polygon: IntArray


def triangulate(
    polygons: Sequence[Sequence[Sequence[int]]], points: FloatArray, notes: Counter[str]
) -> Triangles:
    """Triangles of all polygons, in their order.

    polygons: of each its rings, the outer one first, as indices into points (V, 3) m. notes counts
    the polygons without area, which are left out, and those whose outline crosses itself.
    """
    found, owners = [np.empty((0, 3), np.int64)], [np.empty(0, np.int64)]
    for number, rings in enumerate(polygons):
        triangles = _triangles_of(rings, points, notes)
        found.append(triangles)
        owners.append(np.full(len(triangles), number))
    return Triangles(np.concatenate(found), np.concatenate(owners))


def newell_normal(ring: FloatArray) -> FloatArray:
    """Twice the vector area of a closed ring (N, 3): Newell's normal, of any length."""
    x, y, z = (ring - ring[0]).T
    after = np.r_[1 : len(ring), 0]
    x1, y1, z1 = x[after], y[after], z[after]
    return np.array((np.sum(y * z1 - z * y1), np.sum(z * x1 - x * z1), np.sum(x * y1 - y * x1)))


def plane_axes(normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Unit vectors u, v with u x v along the unit normal; v points up where the normal lets it."""
    x, y, z = normal
    # The z-axis, or the y-axis where the face is nearly level, times the normal.
    u = np.array((-y, x, 0.0) if abs(z) < 0.9 else (z, 0.0, -x))
    u /= np.sqrt(u @ u)
    v = np.array((y * u[2] - z * u[1], z * u[0] - x * u[2], x * u[1] - y * u[0]))
    return u, v


def _triangles_of(
    rings: Sequence[Sequence[int]], points: FloatArray, notes: Counter[str]
) -> IntArray:
    kept = [_without_repeats(np.array(ring, dtype=np.int64), points) for ring in rings]
    outer = kept[0]
    normal = newell_normal(points[outer]) if len(outer) >= 3 else np.zeros(3)
    length = float(np.linalg.norm(normal))
    if 0.5 * length < SMALLEST_AREA:
        notes["faces without area, left out"] += 1
        return np.empty((0, 3), np.int64)
    holes = [ring for ring in kept[1:] if len(ring) >= 3]
    if len(outer) == 3 and not holes:
        return outer[None, :]
    return _ear_cut([outer, *holes], points, normal / length, notes)


def _without_repeats(ring: IntArray, points: FloatArray) -> IntArray:
    """The ring without vertices that lie where the one before them lies (closing ones too)."""
    if len(ring) < 2:
        return ring
    places = points[ring]
    return ring[(places != places[np.r_[-1, 0 : len(ring) - 1]]).any(axis=1)]


def _ear_cut(
    rings: list[IntArray], points: FloatArray, normal: FloatArray, notes: Counter[str]
) -> IntArray:
    indices = np.concatenate(rings)
    ends = np.cumsum([len(ring) for ring in rings]).astype(np.uint32)
    u, v = plane_axes(normal)
    flat = (points[indices] - points[indices[0]]) @ np.column_stack((u, v))
    corners = mapbox_earcut.triangulate_float64(np.ascontiguousarray(flat), ends)
    corners = corners.reshape(-1, 3).astype(np.int64)
    areas = _signed_areas(flat[corners])
    # The outer ring runs counter-clockwise about its own normal, and so must its triangles.
    corners[areas < 0] = corners[areas < 0][:, ::-1]
    bounds = np.split(flat, ends[:-1])
    area = abs(_ring_area(bounds[0])) - sum(abs(_ring_area(ring)) for ring in bounds[1:])
    if abs(np.abs(areas).sum() - area) > _AREA_MISFIT * max(area, SMALLEST_AREA):
        notes["faces whose outline crosses itself, kept as they could be cut"] += 1
    return indices[corners[np.abs(areas) > 0]]


def _signed_areas(triangles: FloatArray) -> FloatArray:
    """(T,) of triangles (T, 3, 2)."""
    a, b = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    return 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def _ring_area(ring: FloatArray) -> float:
    x, y = ring.T
    after = np.r_[1 : len(ring), 0]
    return 0.5 * float(x @ y[after] - x[after] @ y)
