# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Lays windows on the walls of a town: rows by floor height, columns by spacing.

The wall triangles of a building that lie in one plane are joined to polygons, whatever faces the
file cut them into; a window must lie in one of them whole, with a margin, and have free space in
front. So gables and holes carry windows only where they fit, and party walls carry none.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from nightcity.city.cityjson_geometry import Surface
from nightcity.city.free_space import FreeSpace
from nightcity.city.model import FloatArray, IntArray
from nightcity.city.town_meshes import TownMesh, nearly_vertical
from nightcity.city.town_options import TownOptions
from nightcity.city.triangulate import plane_axes
from nightcity.progress import Progress

# Triangles within these of a wall's largest belong to its plane. The distance must stay below the
# windows' offset, or a wall could hide its own windows; the outermost vertex counts for that.
_PLANE_DISTANCE = 0.005  # m
_PLANE_COSINE = np.cos(np.radians(1.0))
_GRID = 1e-3  # m, to which outlines are snapped when they are joined, as CityJSON stores them
_SMALLEST_WALL = 1e-4  # m^2 of a triangle that counts
# Rays start this far beyond the edges of a window, so that its frame is free too.
_FRAME = 0.05  # m


@dataclass(frozen=True)
class LaidWindows:
    """centres, outward: (N, 3) m and unit. half_u, half_v: (N, 3) m, their cross product outward.
    building: (N,) number of the mesh. wall: (N,) numbers walls across the town."""

    centres: FloatArray
    half_u: FloatArray
    half_v: FloatArray
    outward: FloatArray
    building: IntArray
    wall: IntArray

    def __len__(self) -> int:
        return len(self.building)

    def take(self, chosen: IntArray | np.ndarray) -> LaidWindows:
        """The windows of these numbers or this mask."""
        return LaidWindows(
            self.centres[chosen],
            self.half_u[chosen],
            self.half_v[chosen],
            self.outward[chosen],
            self.building[chosen],
            self.wall[chosen],
        )


@dataclass(frozen=True)
class Wall:
    """One polygon in a plane: outline in (u, v) m about origin, which lies in the plane."""

    origin: FloatArray
    u: FloatArray
    v: FloatArray
    outward: FloatArray
    outline: shapely.Polygon


def lay_windows(meshes: Sequence[TownMesh], options: TownOptions) -> LaidWindows:
    """The windows that fit on the walls of each building, whatever stands in front of them.

    Sheds carry none. Ordered by building, then wall, then row.
    """
    found: list[tuple[Wall, FloatArray, int]] = []
    with Progress("laying windows", len(meshes)) as progress:
        for building, mesh in enumerate(meshes):
            if mesh.footprint_area() >= options.shed_area:
                laid = ((wall, _places(wall, options), building) for wall in walls(mesh))
                found += [entry for entry in laid if len(entry[1])]
            progress.advance()
    counts = np.array([len(places) for _, places, _ in found], dtype=np.int64)

    def of_walls(values: list[FloatArray]) -> FloatArray:
        return np.repeat(np.array(values).reshape(-1, 3), counts, axis=0)

    u, v = of_walls([wall.u for wall, _, _ in found]), of_walls([wall.v for wall, _, _ in found])
    outward = of_walls([wall.outward for wall, _, _ in found])
    places = np.concatenate([np.empty((0, 2)), *(places for _, places, _ in found)])
    centres = of_walls([wall.origin for wall, _, _ in found]) + options.window_offset * outward
    return LaidWindows(
        centres + places[:, :1] * u + places[:, 1:] * v,
        0.5 * options.window_width * u,
        0.5 * options.window_height * v,
        outward,
        np.repeat(np.array([building for _, _, building in found], dtype=np.int64), counts),
        np.repeat(np.arange(len(found)), counts),
    )


def with_free_space(windows: LaidWindows, space: FreeSpace, clearance: float) -> np.ndarray:
    """(N,) whether a window has clearance (m) of free space in front, and is inside no building."""
    free = np.ones(len(windows), dtype=bool)
    grid = [(s, t) for s in (-1.0, 0.0, 1.0) for t in (-1.0, 0.0, 1.0)]
    for s, t in sorted(grid, key=lambda place: abs(place[0]) + abs(place[1])):
        left = np.flatnonzero(free)
        some = windows.take(left)
        starts = some.centres + s * _widened(some.half_u) + t * _widened(some.half_v)
        hit = np.isfinite(space.distances(starts, some.outward, max(clearance, _FRAME)))
        inside = space.covered(starts + clearance * some.outward)
        free[left[hit | inside]] = False
    return free


def walls(mesh: TownMesh) -> Iterator[Wall]:
    """The walls of a building, the largest plane first."""
    normals = mesh.unit_normals()
    corners = mesh.corners()
    areas = 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    is_wall = (mesh.surfaces == Surface.WALL) & nearly_vertical(normals) & (areas > _SMALLEST_WALL)
    left = np.flatnonzero(is_wall)
    left = left[np.argsort(-areas[left], kind="stable")]
    while len(left):
        seed = left[0]
        distance = np.abs((corners[left] - corners[seed, 0]) @ normals[seed]).max(axis=1)
        same = (distance <= _PLANE_DISTANCE) & (normals[left] @ normals[seed] >= _PLANE_COSINE)
        same[0] = True
        yield from _joined_walls(corners[left[same]], normals[seed])
        left = left[~same]


def _joined_walls(corners: FloatArray, outward: FloatArray) -> Iterator[Wall]:
    """The polygons that the triangles (T, 3, 3) of one plane make together."""
    u, v = plane_axes(outward)
    # (u, v, outward) is right-handed; v points up. The plane runs through the outermost vertex.
    about = corners[0, 0]
    flat = (corners - about) @ np.column_stack((u, v))
    origin = about + outward * ((corners - about) @ outward).max()
    if len(flat) == 1:
        yield Wall(origin, u, v, outward, shapely.polygons(flat[0]))
        return
    joined = shapely.union_all(shapely.polygons(flat), grid_size=_GRID)
    for outline in shapely.get_parts(joined):
        if outline.geom_type == "Polygon":
            yield Wall(origin, u, v, outward, outline)


def _places(wall: Wall, options: TownOptions) -> FloatArray:
    """(N, 2) centres in (u, v) of the windows that fit on a wall, row by row from below."""
    left, low, right, high = wall.outline.bounds
    half_width = 0.5 * options.window_width + options.window_margin
    half_height = 0.5 * options.window_height + options.window_margin
    across = _columns(left + half_width, right - half_width, options.window_spacing)
    if len(across) == 0:
        return np.empty((0, 2))
    # v runs up the wall: floors are heights above the street, z = 0.
    street = -wall.origin[2] / wall.v[2]
    first = options.sill_height + 0.5 * options.window_height
    floors = np.arange(
        np.ceil(((low + half_height - street) * wall.v[2] - first) / options.floor_height - 1e-9),
        np.floor(((high - half_height - street) * wall.v[2] - first) / options.floor_height + 1e-9)
        + 1,
    )
    floors = floors[floors >= 0]
    heights = street + (first + floors * options.floor_height) / wall.v[2]
    places = np.stack(np.meshgrid(across, heights), axis=-1).reshape(-1, 2)
    # Outlines are snapped to a grid, so a window may overlap the margin by two steps of it.
    half_width, half_height = half_width - 2 * _GRID, half_height - 2 * _GRID
    boxes = shapely.box(
        places[:, 0] - half_width,
        places[:, 1] - half_height,
        places[:, 0] + half_width,
        places[:, 1] + half_height,
    )
    shapely.prepare(wall.outline)
    return places[shapely.covers(wall.outline, boxes)]


def _columns(first: float, last: float, spacing: float) -> FloatArray:
    """Positions from first to last, spacing apart, in the middle of the room there is."""
    if last < first - _GRID:
        return np.empty(0)
    count = int(np.floor((last - first) / spacing + 1e-9)) + 1
    return 0.5 * (first + last) + spacing * (np.arange(count) - 0.5 * (count - 1))


def _widened(half: FloatArray) -> FloatArray:
    """Half edges (N, 3) longer by the frame."""
    length = np.linalg.norm(half, axis=1, keepdims=True)
    return half * (1 + _FRAME / length)
