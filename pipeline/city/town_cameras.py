# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Cameras for a real town: overviews of its densest part, one in a street, one at a window.

The names are those of the generated cities and mean the same.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from nightcity.city.cameras import look_along, overview_cameras
from nightcity.city.free_space import FreeSpace
from nightcity.city.model import BoolArray, Camera, FloatArray, MediaBox
from nightcity.city.town_meshes import TownMesh
from nightcity.city.wall_windows import LaidWindows

_DISTRICT = 200.0  # m, edge of the square that the overviews frame
_AROUND = 15.0  # m around the district that street and close may lie in
_DISTRICT_STEP = 40.0  # m between the squares that are tried
_FOV = 60.0  # degrees, vertical, as the paper scenes' street camera
_EYE_HEIGHT = 1.7  # m
_EYE_STEP = 4.0  # m between places that are tried in a street
_EYE_ROOM = 2.5  # m of free space around the eye
_MOST_EYES = 800  # places whose views are compared, spread evenly
_SECTORS = 32  # directions that are tried
_STREET_REACH = 70.0  # m that a street view is judged by
_STREET_WIDTH = 25.0  # m; walls farther than this do not make a street
_NEAREST_SIGHT = 4.0  # m; a window that is closer fills the view and is no street
_VIEW_HALF_ANGLE = np.radians(35.0)
_PITCH = 0.1  # rise of the street view, m a metre
_FINALISTS = 24  # views whose windows are counted by rays
_CLOSE_DISTANCE = 2.0  # m in front of a window
_CLOSE_ROOM = (6.0, _CLOSE_DISTANCE + 0.5)  # m of free space in front of it, in this order
_CLOSE_REACH = 40.0  # m along a facade
_BLOCK = 256  # eyes at a time


@dataclass(frozen=True)
class _Lit:
    """Lit windows. centres, outward, across: (N, 3). wall: (N,)."""

    centres: FloatArray
    outward: FloatArray
    across: FloatArray
    wall: np.ndarray


def town_cameras(
    meshes: Sequence[TownMesh],
    windows: LaidWindows,
    light_on: BoolArray,
    media: Sequence[MediaBox],
    space: FreeSpace,
    notes: Counter[str],
) -> tuple[Camera, ...]:
    """overview75, 25, 50, 100 and far25 of the densest district; street and close where there is a
    place for them, which is noted where there is none."""
    lo, hi = _dense_district(meshes, windows)
    cameras = list(overview_cameras(lo, hi, 0.5 * (lo + hi)[:2]))
    lo, hi = lo - _AROUND, hi + _AROUND
    chosen = windows.take(light_on & _inside(windows.centres, lo, hi))
    across = chosen.half_u / np.maximum(np.linalg.norm(chosen.half_u, axis=1, keepdims=True), 1e-9)
    lit = _Lit(chosen.centres, chosen.outward, across, chosen.wall)
    for name, camera in (
        ("street", _street(lit, media, space, lo, hi)),
        ("close", _close(lit, space)),
    ):
        if camera is None:
            notes[f"cameras without a free place before lit windows, left out ({name})"] += 1
        else:
            cameras.append(camera)
    return tuple(cameras)


def _dense_district(
    meshes: Sequence[TownMesh], windows: LaidWindows
) -> tuple[FloatArray, FloatArray]:
    """The corners, m, of the buildings in the square that holds most windows (or buildings, where
    there is no window)."""
    lows = np.array([mesh.positions.min(axis=0) for mesh in meshes])
    highs = np.array([mesh.positions.max(axis=0) for mesh in meshes])
    middles = 0.5 * (lows + highs)
    places = (windows.centres if len(windows) else middles)[:, :2]
    first = places.min(axis=0)
    cells = np.floor((places - first) / _DISTRICT_STEP).astype(np.int64)
    span = round(_DISTRICT / _DISTRICT_STEP)
    counts = np.zeros(cells.max(axis=0) + 1 + span, dtype=np.int64)
    np.add.at(counts, (cells[:, 0] + 1, cells[:, 1] + 1), 1)
    sums = counts.cumsum(axis=0).cumsum(axis=1)
    inside = sums[span:, span:] - sums[:-span, span:] - sums[span:, :-span] + sums[:-span, :-span]
    corner = first + np.array(np.unravel_index(inside.argmax(), inside.shape)) * _DISTRICT_STEP
    chosen = ((middles[:, :2] >= corner) & (middles[:, :2] <= corner + _DISTRICT)).all(axis=1)
    if not chosen.any():  # one building larger than the square
        chosen[:] = True
    return lows[chosen].min(axis=0) * (1, 1, 0), highs[chosen].max(axis=0)


def _inside(points: FloatArray, lo: FloatArray, hi: FloatArray) -> BoolArray:
    return ((points >= lo) & (points <= hi)).all(axis=1)


def _street(
    lit: _Lit, media: Sequence[MediaBox], space: FreeSpace, lo: FloatArray, hi: FloatArray
) -> Camera | None:
    """A view along a street, from inside the medium, with as many lit windows as there are."""
    eyes = _eyes(media, lo, hi)
    eyes = eyes[~space.covered(eyes)]
    eyes = eyes[(_open_distances(eyes, space, 8, _EYE_ROOM) >= _EYE_ROOM).all(axis=1)]
    eyes = eyes[:: len(eyes) // _MOST_EYES + 1]
    if len(eyes) == 0 or len(lit.wall) == 0:
        return None
    open_distance = _open_distances(eyes, space, _SECTORS, _STREET_REACH)
    # Among walls, not on the open ground before them.
    enclosed = (open_distance < _STREET_WIDTH).mean(axis=1)
    scores = np.concatenate(list(_view_scores(eyes, open_distance, lit))) * enclosed[:, None]
    order = np.argsort(-scores, axis=None, kind="stable")[:_FINALISTS]
    eye, sector = np.unravel_index(order, scores.shape)
    views = _directions(_SECTORS)[sector]
    seen = np.array([_seen(eyes[e], view, lit, space) for e, view in zip(eye, views, strict=True)])
    best = int(np.argmax(seen * open_distance[eye, sector] * enclosed[eye]))
    if seen[best] == 0:
        return None
    return look_along("street", eyes[eye[best]], views[best] + (0.0, 0.0, _PITCH), _FOV)


def _eyes(media: Sequence[MediaBox], lo: FloatArray, hi: FloatArray) -> FloatArray:
    """(N, 3) places at eye height in the district, inside media boxes."""
    boxes = [
        (np.maximum(box.lo, lo)[:2], np.minimum(box.hi, hi)[:2])
        for box in media
        if box.lo[2] < _EYE_HEIGHT < box.hi[2]
    ]
    places = [np.empty((0, 2))]
    for low, high in boxes:
        axes = [
            np.arange(a + 0.5 * _EYE_STEP, b, _EYE_STEP) for a, b in zip(low, high, strict=True)
        ]
        places.append(np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2))
    plan = np.concatenate(places)
    return np.column_stack((plan, np.full(len(plan), _EYE_HEIGHT)))


def _directions(count: int) -> FloatArray:
    """(count, 3) horizontal unit vectors, all around."""
    angle = 2 * np.pi * np.arange(count) / count
    return np.column_stack((np.cos(angle), np.sin(angle), np.zeros(count)))


def _open_distances(eyes: FloatArray, space: FreeSpace, count: int, reach: float) -> FloatArray:
    """(N, count) m to the first wall all around, at eye height; at most reach."""
    directions = np.tile(_directions(count), (len(eyes), 1))
    distance = space.distances(np.repeat(eyes, count, axis=0), directions, reach)
    return np.minimum(distance, reach).reshape(-1, count)


def _view_scores(eyes: FloatArray, open_distance: FloatArray, lit: _Lit) -> Iterator[FloatArray]:
    """Blocks of (eyes, sectors): how many lit windows a view holds that no wall nearer than they
    are hides at eye height, times how far it reaches."""
    angles = 2 * np.pi * np.arange(_SECTORS) / _SECTORS
    apart = np.abs((angles[:, None] - angles + np.pi) % (2 * np.pi) - np.pi)
    in_view = (apart <= _VIEW_HALF_ANGLE).astype(float)
    for start in range(0, len(eyes), _BLOCK):
        block = slice(start, start + _BLOCK)
        to_window = lit.centres - eyes[block, None]
        distance = np.linalg.norm(to_window[..., :2], axis=-1)
        sector = np.round(
            np.arctan2(to_window[..., 1], to_window[..., 0]) * _SECTORS / (2 * np.pi)
        ).astype(np.int64)
        sector %= _SECTORS
        wall = np.take_along_axis(open_distance[block], sector, axis=1)
        facing = np.einsum("ewk,wk->ew", to_window, lit.outward) < -0.1 * distance
        shown = facing & (distance <= wall + 2.0) & (distance > _NEAREST_SIGHT)
        eye = np.broadcast_to(np.arange(len(distance))[:, None], sector.shape)
        counts = np.zeros((len(distance), _SECTORS))
        np.add.at(counts, (eye[shown], sector[shown]), 1.0)
        yield (counts @ in_view) * open_distance[block]


def _seen(eye: FloatArray, direction: FloatArray, lit: _Lit, space: FreeSpace) -> int:
    """How many lit windows an eye sees within the view, by rays."""
    to_window = lit.centres - eye
    distance = np.linalg.norm(to_window, axis=1)
    unit = to_window / distance[:, None]
    in_view = (unit @ direction > np.cos(_VIEW_HALF_ANGLE)) & (distance > _NEAREST_SIGHT)
    in_view &= (distance < 1.5 * _STREET_REACH) & (np.einsum("ij,ij->i", unit, lit.outward) < -0.1)
    chosen = np.flatnonzero(in_view)
    # From the window back to the eye: the window lies in front of its own wall.
    free = space.distances(lit.centres[chosen], -unit[chosen], 1.5 * _STREET_REACH)
    return int((free >= distance[chosen]).sum())


def _close(lit: _Lit, space: FreeSpace) -> Camera | None:
    """2 m in front of a lit window, looking along its facade, where lit windows follow."""
    eyes = lit.centres + _CLOSE_DISTANCE * lit.outward
    outside = ~space.covered(eyes)
    for room in _CLOSE_ROOM:
        free = outside & np.isinf(space.distances(lit.centres, lit.outward, room))
        views = [_along_facade(lit, eyes, side, free, space) for side in (1.0, -1.0)]
        score, eye, direction = max(views, key=lambda view: view[0])
        if score > 0:
            return look_along("close", eye, direction, _FOV)
    return None


def _along_facade(
    lit: _Lit, eyes: FloatArray, side: float, free: BoolArray, space: FreeSpace
) -> tuple[float, FloatArray, FloatArray]:
    """The best free eye that looks to one side: its score, the eye and the direction; score 0
    where no eye is free. Lit windows of the wall count by how near they are, its own included."""
    along = side * lit.across
    ahead = space.distances(eyes, along, _CLOSE_REACH)
    order = np.argsort(lit.wall, kind="stable")
    starts = np.searchsorted(lit.wall[order], lit.wall, side="left")
    ends = np.searchsorted(lit.wall[order], lit.wall, side="right")
    best = 0.0, np.zeros(3), np.zeros(3)
    for index in np.flatnonzero(free & (ahead > 2 * _CLOSE_DISTANCE)):
        others = lit.centres[order[starts[index] : ends[index]]] - lit.centres[index]
        beside = others @ along[index]
        shown = (beside > -0.1) & (beside < ahead[index])
        score = float((1 / np.maximum(np.linalg.norm(others[shown], axis=1), 1.0)).sum())
        if score > best[0]:
            best = score, eyes[index], along[index]
    return best
