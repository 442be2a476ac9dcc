# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The ground plane: a horizontal mesh with NightcityGroundAPI."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nightcity.errors import SceneError
from nightcity.export.findings import Item
from nightcity.export.geometry import face_materials, surfaces_of
from nightcity.export.materials import Materials
from nightcity.export.mesh import read_mesh
from nightcity.export.open_stage import Source

_FLAT = 1e-3  # m; twice float32's rounding at 8 km


@dataclass(frozen=True, slots=True)
class Ground:
    """height: m, on the stage. material: into the table of materials. path: of the prim."""

    height: float
    material: int
    path: str


def read_grounds(source: Source, items: Sequence[Item], materials: Materials) -> list[Ground]:
    """The ground, if any. Raises SceneError where it is not horizontal or there are two."""
    paths = [str(item.prim.GetPath()) for item in items for _ in range(len(item.matrices))]
    _refuse_second(paths)
    return [_read(source, item, materials) for item in items]


def only_ground(grounds: Sequence[Ground]) -> Ground | None:
    """The ground out of those of all parts. Raises SceneError where there are two."""
    _refuse_second([ground.path for ground in grounds])
    return grounds[0] if grounds else None


def _refuse_second(paths: Sequence[str]) -> None:
    if len(paths) > 1:
        raise SceneError(
            f"{' and '.join(paths[:2])}: a scene has one ground; remove NightcityGroundAPI from the"
            " others"
        )


def _read(source: Source, item: Item, materials: Materials) -> Ground:
    subsets, surfaces = surfaces_of(item.prim, materials)
    mesh = read_mesh(source, item.prim, None)
    if mesh is None or len(mesh.faces) == 0:
        raise SceneError(f"{item.prim.GetPath()}: a ground needs a mesh with at least one face")
    matrix = item.matrices[0]
    heights = mesh.points[np.unique(mesh.triangles)] @ matrix[:3, 2] + matrix[3, 2]
    if np.ptp(heights) > _FLAT:
        raise SceneError(
            f"{item.prim.GetPath()}: NightcityGroundAPI needs a horizontal mesh, but its height"
            f" goes from {heights.min():g} to {heights.max():g} m"
        )
    faces = face_materials(source, item.prim, mesh.face_count, subsets, surfaces, materials)
    material = materials.untextured(int(faces[mesh.faces[0]]), item.prim.GetPath())
    return Ground(float(np.median(heights)), material, str(item.prim.GetPath()))
