# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Opaque geometry: every Gprim's triangles, materials and building, in metres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom, UsdShade

from nightcity.errors import SceneError
from nightcity.export.findings import Item
from nightcity.export.materials import Materials, Surface
from nightcity.export.mesh import LocalMesh, read_mesh
from nightcity.export.open_stage import Source
from nightcity.export.records import NONE
from nightcity.progress import Progress

# Also below the classes and overs that hold prototypes.
_SUBSETS = Usd.TraverseInstanceProxies(
    Usd.PrimIsActive & Usd.PrimIsLoaded & Usd.PrimHasDefiningSpecifier
)
_CHUNK = 4096  # prims whose bindings USD resolves in one call


@dataclass
class Geometry:
    """positions: (V, 3) m, double. texcoords: (V, 2), or None where nothing is textured.
    vertices: (T, 3) into positions. materials, buildings: (T,), building -1 for none."""

    positions: NDArray[np.float64]
    texcoords: NDArray[np.float32] | None
    vertices: NDArray[np.int64]
    materials: NDArray[np.int64]
    buildings: NDArray[np.int64]


def read_geometry(source: Source, items: Sequence[Item], materials: Materials) -> Geometry:
    """All items as triangles. Raises SceneError naming the prim that cannot be read."""
    parts = _Parts()
    meshes: dict[tuple[str, str | None], LocalMesh | None] = {}
    with Progress("reading geometry", len(items)) as progress:
        for start in range(0, len(items), _CHUNK):
            chunk = items[start : start + _CHUNK]
            subsets = [_face_subsets(item.prim) for item in chunk]
            bound = _bound_surfaces(chunk, subsets, materials)
            for item, own_subsets in zip(chunk, subsets, strict=True):
                surfaces = [next(bound) for _ in range(len(own_subsets) + 1)]
                primvar = next((s.primvar for s in surfaces if s and s.primvar), None)
                mesh = _read_once(source, item, primvar, meshes)
                if mesh is not None:
                    faces = face_materials(
                        source, item.prim, mesh.face_count, own_subsets, surfaces, materials
                    )
                    parts.add(item, mesh, faces)
                progress.advance()
    return parts.joined()


def joined_geometry(
    parts: Sequence[Geometry], materials: Sequence[NDArray[np.int64]], buildings: Sequence[int]
) -> Geometry:
    """One after the other. materials[i]: what part i's materials have become. buildings[i]: the
    number that its buildings count from."""
    vertices = np.cumsum([0] + [len(part.positions) for part in parts])
    textured = any(part.texcoords is not None for part in parts)
    return Geometry(
        np.concatenate([part.positions for part in parts]),
        np.concatenate([_texcoords(part) for part in parts]) if textured else None,
        np.concatenate([p.vertices + first for p, first in zip(parts, vertices, strict=False)]),
        np.concatenate([now[p.materials] for p, now in zip(parts, materials, strict=True)]),
        np.concatenate(
            [
                np.where(part.buildings < 0, -1, part.buildings + first)
                for part, first in zip(parts, buildings, strict=False)
            ]
        ),
    )


def _texcoords(geometry: Geometry) -> NDArray[np.float32]:
    if geometry.texcoords is not None:
        return geometry.texcoords
    return np.zeros((len(geometry.positions), 2), np.float32)


def face_materials(
    source: Source,
    prim: Usd.Prim,
    face_count: int,
    subsets: Sequence[Usd.Prim],
    surfaces: Sequence[Surface | None],
    materials: Materials,
) -> NDArray[np.int64]:
    """(F,) the material of each face. surfaces: the prim's own, then one for each subset."""
    chosen = np.full(face_count, -1 if surfaces[0] is None else surfaces[0].index)
    for subset, surface in zip(subsets, surfaces[1:], strict=True):
        indices = np.array(source.value(subset, "indices", ()), dtype=np.int64)
        if len(indices) and (indices.min() < 0 or indices.max() >= face_count):
            raise SceneError(
                f"{subset.GetPath()}.indices must lie between 0 and {face_count - 1}, but reaches"
                f" {indices.min()} and {indices.max()}"
            )
        if surface is not None:
            chosen[indices] = surface.index
    bare = chosen < 0
    if bare.any():
        for surface, faces in materials.of_display_colour(prim, face_count):
            shown = (
                np.ones(face_count, bool)
                if faces is None
                else np.isin(np.arange(face_count), faces)
            )
            chosen[bare & shown] = surface.index
    return chosen


def surfaces_of(prim: Usd.Prim, materials: Materials) -> tuple[list[Usd.Prim], list]:
    """A prim's face subsets, and the surfaces bound to it and to each of them."""
    item_subsets = _face_subsets(prim)
    bound = UsdShade.MaterialBindingAPI.ComputeBoundMaterials(
        [prim, *item_subsets], UsdShade.Tokens.full
    )[0]
    return item_subsets, [materials.of_material(m) if m else None for m in bound]


def _face_subsets(prim: Usd.Prim) -> list[Usd.Prim]:
    return [
        child
        for child in prim.GetFilteredChildren(_SUBSETS)
        if child.GetTypeName() == "GeomSubset"
        and child.GetAttribute("familyName").Get() == UsdShade.Tokens.materialBind
        and child.GetAttribute("elementType").Get() == UsdGeom.Tokens.face
    ]


def _bound_surfaces(items: Sequence[Item], subsets: Sequence[list[Usd.Prim]], materials: Materials):
    """Surfaces, or None, of each prim and its subsets, in this order."""
    prims = [prim for item, own in zip(items, subsets, strict=True) for prim in (item.prim, *own)]
    bound = UsdShade.MaterialBindingAPI.ComputeBoundMaterials(prims, UsdShade.Tokens.full)[0]
    return (materials.of_material(material) if material else None for material in bound)


def _read_once(
    source: Source,
    item: Item,
    primvar: str | None,
    meshes: dict[tuple[str, str | None], LocalMesh | None],
) -> LocalMesh | None:
    """The mesh of a prim; that of a native instance is read once for all its instances."""
    if not item.prim.IsInstanceProxy():
        return read_mesh(source, item.prim, primvar)
    key = (item.source_path, primvar)
    if key not in meshes:
        meshes[key] = read_mesh(source, item.prim, primvar)
    return meshes[key]


@dataclass
class _Parts:
    """Collects arrays, to be joined once."""

    positions: list = field(default_factory=list)
    texcoords: list = field(default_factory=list)
    vertices: list = field(default_factory=list)
    materials: list = field(default_factory=list)
    buildings: list = field(default_factory=list)
    count: int = 0
    textured: bool = False

    def add(self, item: Item, mesh: LocalMesh, face_material: NDArray[np.int64]) -> None:
        """Every copy of one prim."""
        copies, points = len(item.matrices), len(mesh.points)
        if self.count + copies * points > NONE:
            raise SceneError(
                f"{item.prim.GetPath()}: with its {copies} instances the scene has more than"
                f" {NONE} vertices; a flat scene holds every instance, so leave some out"
            )
        matrices = item.matrices
        world = mesh.points @ matrices[:, :3, :3] + matrices[:, None, 3, :3]
        # A mirrored copy turns its triangles over, so that outside stays outside.
        with np.errstate(over="ignore"):
            mirrored = np.linalg.det(matrices[:, :3, :3]) < 0
        wound = np.where(mirrored[:, None, None], mesh.triangles[:, ::-1], mesh.triangles)
        first = self.count + points * np.arange(copies)
        self.positions.append(world.reshape(-1, 3))
        self.vertices.append((wound + first[:, None, None]).reshape(-1, 3))
        self.materials.append(np.tile(face_material[mesh.faces], copies))
        self.buildings.append(np.repeat(item.buildings, len(mesh.triangles)))
        if mesh.texcoords is None:
            self.texcoords.append(np.zeros((copies * points, 2), np.float32))
        else:
            self.textured = True
            self.texcoords.append(np.tile(mesh.texcoords, (copies, 1)))
        self.count += copies * points

    def joined(self) -> Geometry:
        return Geometry(
            np.concatenate([np.empty((0, 3)), *self.positions]),
            np.concatenate([np.empty((0, 2), np.float32), *self.texcoords])
            if self.textured
            else None,
            np.concatenate([np.empty((0, 3), np.int64), *self.vertices]),
            np.concatenate([np.empty(0, np.int64), *self.materials]),
            np.concatenate([np.empty(0, np.int64), *self.buildings]),
        )
