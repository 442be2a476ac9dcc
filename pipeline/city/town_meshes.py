# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Source buildings -> one triangle mesh a building, standing on the plane z = 0.

Terrain is not modelled, so every building is moved down, or up, as a whole until its lowest
ground is at z = 0: heights of walls and floors stay true, and neighbours, whose grounds differ by
little, still meet. Where a part of it stands on higher ground its walls run down to z = 0, unless
it stands on another part. A common datum instead would bury or lift whole streets: the ground of
a town differs by more than the height of its houses.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from nightcity.city.cityjson_buildings import Body, SourceBuilding
from nightcity.city.cityjson_geometry import Surface
from nightcity.city.model import FloatArray, IntArray
from nightcity.city.triangulate import triangulate

LEAST_HEIGHT = 0.1  # m; flatter is a footprint, not a building
_NEARLY_VERTICAL = 0.1  # largest |z| of a wall's unit normal, about 6 degrees
_SAME_LEVEL = 0.05  # m
_TERRAIN_STEP = 1.5  # m that the foot of one body follows the terrain, where nothing marks it
_MILLIMETRE = 1e-3


@dataclass(frozen=True)
class TownMesh:
    """Triangles of a building or a part. positions: (V, 3) m. triangles: (T, 3), counter-clockwise
    seen from outside. surfaces: (T,) values of Surface, none of them UNKNOWN."""

    name: str
    positions: FloatArray
    triangles: IntArray
    surfaces: IntArray

    def corners(self) -> FloatArray:
        """(T, 3, 3) m."""
        return self.positions[self.triangles]

    def unit_normals(self) -> FloatArray:
        """(T, 3), outward."""
        return unit_normals(self.corners())

    def footprint_area(self) -> float:
        """m^2 of all faces that look up, in plan."""
        return float(np.maximum(_vector_areas(self.corners())[:, 2], 0).sum())


def nearly_vertical(normals: FloatArray) -> np.ndarray:
    """(N,) whether a face with this unit normal (N, 3) can be a wall."""
    return np.abs(normals[:, 2]) < _NEARLY_VERTICAL


def unit_normals(corners: FloatArray) -> FloatArray:
    """(T, 3) of triangles (T, 3, 3)."""
    areas = _vector_areas(corners)
    return areas / np.maximum(np.linalg.norm(areas, axis=1, keepdims=True), 1e-300)


def building_mesh(
    source: SourceBuilding, points: FloatArray, notes: Counter[str]
) -> tuple[TownMesh, float] | None:
    """The building on z = 0, and the height of its ground in points (V, 3) m; None if it has no
    shape. notes counts what is left out or mended."""
    own = _body_mesh(source.own, points, notes) if source.own else None
    parts = [_body_mesh(body, points, notes) for body in source.parts]
    bodies = [part for part in parts if part is not None]
    if own is not None:
        if bodies and _is_hull(own, bodies):
            notes["Buildings with geometry around their parts, which are taken instead"] += 1
        else:
            bodies.insert(0, own)
    if not bodies:
        notes["buildings without a face that has an area, left out"] += 1
        return None
    ground = min(float(body.positions[:, 2].min()) for body in bodies)
    mesh = _joined(source.name, _standing(bodies, ground))
    if len(mesh.triangles) == 0 or mesh.positions[:, 2].max() < LEAST_HEIGHT:
        notes["buildings without height (footprints only), left out"] += 1
        return None
    return mesh, ground


def _body_mesh(body: Body, points: FloatArray, notes: Counter[str]) -> TownMesh | None:
    rings = [polygon for found in body.polygons for polygon in found.rings]
    surfaces = np.array([surface for found in body.polygons for surface in found.surfaces])
    cut = triangulate(rings, points, notes)
    if len(cut.vertices) == 0:
        return None
    # By place, not by index: some files repeat a vertex for every face.
    positions, triangles = np.unique(points[cut.vertices.ravel()], axis=0, return_inverse=True)
    mesh = TownMesh(body.name, positions, triangles.reshape(-1, 3), surfaces[cut.polygon])
    if _volume(mesh) < 0:
        notes["buildings or parts inside out, turned"] += 1
        mesh = replace(mesh, triangles=mesh.triangles[:, ::-1])
    return replace(mesh, surfaces=_classified(mesh))


def _classified(mesh: TownMesh) -> IntArray:
    """Surfaces with the unknown ones told by their normals."""
    normals = mesh.unit_normals()
    foot = mesh.positions[:, 2].min() + _SAME_LEVEL
    at_foot = (mesh.corners()[:, :, 2] <= foot).all(axis=1)
    by_normal = np.select(
        [nearly_vertical(normals), normals[:, 2] > 0, at_foot],
        [Surface.WALL, Surface.ROOF, Surface.GROUND],
        Surface.OTHER,
    )
    return np.where(mesh.surfaces == Surface.UNKNOWN, by_normal, mesh.surfaces)


def _standing(bodies: Sequence[TownMesh], ground: float) -> list[TownMesh]:
    """The bodies moved down by ground, the feet of those on the terrain at z = 0 exactly."""
    standing = []
    for body in bodies:
        positions = body.positions - (0.0, 0.0, ground)
        if not _stands_on_another(body, bodies):
            positions[_foot(body), 2] = 0.0
        standing.append(replace(body, positions=positions))
    return standing


def _foot(body: TownMesh) -> IntArray:
    """The vertices that meet the terrain: those of ground surfaces, or else the lowest of walls."""
    ground = body.surfaces == Surface.GROUND
    if ground.any():
        return np.unique(body.triangles[ground])
    walls = np.unique(body.triangles[body.surfaces == Surface.WALL])
    if len(walls) == 0:
        return walls
    z = body.positions[walls, 2]
    plan = np.round(body.positions[walls, :2] / _MILLIMETRE)
    _, column = np.unique(plan, axis=0, return_inverse=True)
    lowest = np.full(column.max() + 1, np.inf)
    np.minimum.at(lowest, column.ravel(), z)
    step = min(_TERRAIN_STEP, 0.5 * float(np.ptp(body.positions[:, 2])))
    return walls[(z <= lowest[column.ravel()] + _MILLIMETRE) & (z <= z.min() + step)]


def _stands_on_another(body: TownMesh, bodies: Sequence[TownMesh]) -> bool:
    """Whether most of a body's footprint lies over bodies whose ground is lower."""
    level = body.positions[:, 2].min()
    lower = [other for other in bodies if other.positions[:, 2].min() < level - _SAME_LEVEL]
    if not lower:
        return False
    own = _footprint([body])
    return own.intersection(_footprint(lower)).area > 0.5 * own.area


def _is_hull(own: TownMesh, parts: Sequence[TownMesh]) -> bool:
    """Whether a Building's own geometry repeats its parts: they cover most of its footprint."""
    footprint = _footprint([own])
    return footprint.intersection(_footprint(parts)).area > 0.5 * footprint.area


def _footprint(bodies: Sequence[TownMesh]) -> shapely.Geometry:
    """The union of all faces that look up, in plan."""
    corners = np.concatenate([body.corners() for body in bodies])
    seen = corners[_vector_areas(corners)[:, 2] > _MILLIMETRE**2][:, :, :2]
    return shapely.union_all(shapely.polygons(seen), grid_size=_MILLIMETRE)


def _joined(name: str, bodies: Sequence[TownMesh]) -> TownMesh:
    """One mesh of all bodies, without the faces that lie in the ground and unused vertices."""
    starts = np.cumsum([0] + [len(body.positions) for body in bodies])
    positions = np.concatenate([body.positions for body in bodies])
    triangles = np.concatenate(
        [body.triangles + start for body, start in zip(bodies, starts[:-1], strict=True)]
    )
    surfaces = np.concatenate([body.surfaces for body in bodies])
    corners = positions[triangles]
    flat = (np.abs(corners[:, :, 2]) < _MILLIMETRE).all(axis=1)
    empty = np.linalg.norm(_vector_areas(corners), axis=1) == 0  # walls that the feet closed up
    kept = ~flat & ~empty
    used, indices = np.unique(triangles[kept], return_inverse=True)
    return TownMesh(name, positions[used], indices.reshape(-1, 3), surfaces[kept])


def _volume(mesh: TownMesh) -> float:
    """Signed volume, m^3, of the mesh closed by a plane at its foot."""
    lo, hi = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    foot = np.array((0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1]), lo[2]))
    corners = mesh.corners() - foot
    return float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6


def _vector_areas(corners: FloatArray) -> FloatArray:
    """(T, 3) m^2, along the normals, of triangles (T, 3, 3)."""
    return 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
