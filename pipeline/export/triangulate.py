# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Polygons to triangles: fans where they are safe, ear clipping (mapbox) where they are not."""

from __future__ import annotations

import mapbox_earcut
import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# A fan triangle may turn against its polygon by this share of the polygon's area: rounding.
_TURN_TOLERANCE = 1e-12


def triangulate(
    points: FloatArray, counts: IntArray, indices: IntArray
) -> tuple[IntArray, IntArray]:
    """Triangles of polygons, wound as the polygons are.

    points: (V, 3). counts: (F,) corners a face. indices: (sum of counts,) into points.
    Returns corners (T, 3), into ``indices``, and the face of each triangle (T,), ascending.
    Faces of fewer than 3 corners have none. A polygon need be neither convex nor planar; it is
    clipped as seen along its area vector.
    """
    starts = np.cumsum(counts) - counts
    corners, owners = [np.empty((0, 3), np.int64)], [np.empty(0, np.int64)]
    for size in np.flatnonzero(np.bincount(counts)[3:]) + 3:
        faces = np.flatnonzero(counts == size)
        loop = starts[faces][:, None] + np.arange(size)
        first = np.broadcast_to(loop[:, :1], (len(faces), size - 2))
        fan = np.stack([first, loop[:, 1:-1], loop[:, 2:]], axis=-1)
        concave = _concave(points[indices[fan]]) if size > 3 else np.zeros(len(faces), bool)
        corners.append(fan[~concave].reshape(-1, 3))
        owners.append(np.repeat(faces[~concave], size - 2))
        for face in np.flatnonzero(concave):
            clipped = loop[face][_clip_ears(points[indices[loop[face]]])]
            corners.append(clipped)
            owners.append(np.full(len(clipped), faces[face]))
    owner = np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    return np.concatenate(corners)[order], owner[order]


def _concave(fan: FloatArray) -> NDArray[np.bool_]:
    """(F,) whether a fan (F, n - 2, 3, 3) folds over; then it does not cover its polygon."""
    areas = np.cross(fan[:, :, 1] - fan[:, :, 0], fan[:, :, 2] - fan[:, :, 0])
    total = areas.sum(axis=1)
    along = np.einsum("fti,fi->ft", areas, total)
    square = np.einsum("fi,fi->f", total, total)
    return (along < -_TURN_TOLERANCE * square[:, None]).any(axis=1)


def _clip_ears(loop: FloatArray) -> IntArray:
    """(T, 3) into one polygon (n, 3), wound as it is."""
    offsets = loop - loop[0]
    area = 0.5 * np.cross(offsets, np.roll(offsets, -1, axis=0)).sum(axis=0)
    axis = int(np.argmax(np.abs(area)))
    flat = np.ascontiguousarray(np.delete(offsets, axis, axis=1))
    ears = mapbox_earcut.triangulate_float64(flat, np.array([len(flat)], dtype=np.uint32))
    ears = ears.astype(np.int64).reshape(-1, 3)
    sides = flat[ears[:, 1:]] - flat[ears[:, :1]]
    turns = sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]
    # Dropping y reverses the sense of the projected loop.
    outward = turns * area[axis] * (-1 if axis == 1 else 1) >= 0
    return np.where(outward[:, None], ears, ears[:, ::-1])
