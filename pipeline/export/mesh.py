# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""One prim's triangles in its own space: a Mesh, or the mesh of an implicit surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from nightcity.errors import SceneError
from nightcity.export.open_stage import Source
from nightcity.export.shapes import implicit_polygons
from nightcity.export.triangulate import triangulate


@dataclass(frozen=True, slots=True)
class LocalMesh:
    """points: (V, 3) in stage units. texcoords: (V, 2) or None. triangles: (T, 3) into points,
    counter-clockwise seen from outside. faces: (T,) the polygon of each; face_count of them."""

    points: NDArray[np.float64]
    texcoords: NDArray[np.float32] | None
    triangles: NDArray[np.int64]
    faces: NDArray[np.int64]
    face_count: int


def read_mesh(source: Source, prim: Usd.Prim, texture_primvar: str | None) -> LocalMesh | None:
    """The triangles of a Gprim; None, with a note, for a type that is left out.

    texture_primvar: the primvar that holds its texture coordinates, None to leave them.
    Raises SceneError naming the prim where its arrays do not fit together.
    """
    if prim.IsA(UsdGeom.Mesh):
        return _polygon_mesh(source, prim, texture_primvar)
    polygons = implicit_polygons(source, prim)
    if polygons is None:
        source.notes.about(
            f"Geometry of type {prim.GetTypeName()} is left out; use a Mesh", prim.GetPath()
        )
        return None
    points, counts, indices = polygons
    corners, faces = triangulate(points, counts, indices)
    return LocalMesh(points, None, indices[corners], faces, len(counts))


def _polygon_mesh(source: Source, prim: Usd.Prim, texture_primvar: str | None) -> LocalMesh | None:
    points = np.array(source.value(prim, "points", ()), dtype=np.float64).reshape(-1, 3)
    counts = np.array(source.value(prim, "faceVertexCounts", ()), dtype=np.int64)
    indices = np.array(source.value(prim, "faceVertexIndices", ()), dtype=np.int64)
    if len(points) == 0 or len(counts) == 0:
        source.notes.about("A mesh without points or faces is left out", prim.GetPath())
        return None
    _check(prim, points, counts, indices)
    if source.value(prim, "subdivisionScheme") != "none":
        source.notes.about("Subdivision surfaces are taken as their control cage", prim.GetPath())
    corners, faces = triangulate(points, counts, indices)
    holes = source.value(prim, "holeIndices")
    if holes:
        kept = ~np.isin(faces, np.array(holes, dtype=np.int64))
        corners, faces = corners[kept], faces[kept]
    if source.value(prim, "orientation") == "leftHanded":
        corners = corners[:, ::-1]
    texcoords = None
    if texture_primvar is not None:
        points, texcoords, indices = _with_texcoords(
            source, prim, texture_primvar, points, counts, indices
        )
    return LocalMesh(points, texcoords, indices[corners], faces, len(counts))


def _check(
    prim: Usd.Prim,
    points: NDArray[np.float64],
    counts: NDArray[np.int64],
    indices: NDArray[np.int64],
) -> None:
    path = prim.GetPath()
    if not np.isfinite(points).all():
        raise SceneError(f"{path}.points holds values that are not finite")
    if counts.min() < 0 or counts.sum() != len(indices):
        raise SceneError(
            f"{path}.faceVertexCounts adds up to {counts.sum()}, but faceVertexIndices has"
            f" {len(indices)} values"
        )
    if len(indices) and (indices.min() < 0 or indices.max() >= len(points)):
        raise SceneError(
            f"{path}.faceVertexIndices must lie between 0 and {len(points) - 1}, but reaches"
            f" {indices.min()} and {indices.max()}"
        )


def _with_texcoords(
    source: Source,
    prim: Usd.Prim,
    name: str,
    points: NDArray[np.float64],
    counts: NDArray[np.int64],
    indices: NDArray[np.int64],
) -> tuple[NDArray[np.float64], NDArray[np.float32] | None, NDArray[np.int64]]:
    """Points split so that each has one texture coordinate: points, texcoords, indices."""
    primvar = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance(name)
    values = primvar.Get(source.time) if primvar else None
    if values is None or len(values) == 0:
        source.notes.about(
            f"A textured mesh has no primvars:{name}; the texture's corner is shown", prim.GetPath()
        )
        return points, None, indices
    values = np.array(values, dtype=np.float32)
    where = f"{prim.GetPath()}.primvars:{name}"
    if values.ndim != 2 or values.shape[1] != 2 or not np.isfinite(values).all():
        raise SceneError(f"{where} must hold finite pairs of numbers")
    interpolation = primvar.GetInterpolation()
    element = _element_of_corner(interpolation, counts, indices)
    picks = np.array(primvar.GetIndices(source.time) or np.arange(len(values)), dtype=np.int64)
    if element.max(initial=-1) >= len(picks):
        raise SceneError(
            f"{where} has {len(picks)} values, too few for its interpolation '{interpolation}'"
        )
    pick = picks[element]
    if pick.min(initial=0) < 0 or pick.max(initial=0) >= len(values):
        raise SceneError(f"{where}:indices must lie between 0 and {len(values) - 1}")
    keys, split = np.unique(indices * len(values) + pick, return_inverse=True)
    return points[keys // len(values)], values[keys % len(values)], split


def _element_of_corner(
    interpolation: str, counts: NDArray[np.int64], indices: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Which element of a primvar each face corner takes."""
    if interpolation == UsdGeom.Tokens.faceVarying:
        return np.arange(len(indices))
    if interpolation in (UsdGeom.Tokens.vertex, UsdGeom.Tokens.varying):
        return indices
    if interpolation == UsdGeom.Tokens.uniform:
        return np.repeat(np.arange(len(counts)), counts)
    return np.zeros(len(indices), dtype=np.int64)
