# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The boundaries of one CityJSON geometry as a flat list of polygons with holes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np

from nightcity.errors import SceneError


class Surface(IntEnum):
    """What a polygon is. UNKNOWN: no semantics; its normal must tell."""

    UNKNOWN = 0
    WALL = 1
    ROOF = 2
    GROUND = 3
    OTHER = 4  # closes the building and is opaque, but carries no windows


_SURFACES = {
    "WallSurface": Surface.WALL,
    "RoofSurface": Surface.ROOF,
    "GroundSurface": Surface.GROUND,
}
# How many levels of lists lie above a polygon, which is a list of rings.
_DEPTH = {
    "MultiSurface": 0,
    "CompositeSurface": 0,
    "Solid": 1,
    "MultiSolid": 2,
    "CompositeSolid": 2,
}
SOLIDS = ("Solid", "MultiSolid", "CompositeSolid")
SURFACES = ("MultiSurface", "CompositeSurface")


@dataclass(frozen=True)
class Polygons:
    """Polygons of one geometry: the rings of each, the outer one first, as vertex indices.

    surfaces: what each is. semantics_misfit: the semantics did not fit and were left out.
    """

    rings: list[list[list[int]]]
    surfaces: list[Surface]
    semantics_misfit: bool = False


def polygons(geometry: Mapping[str, Any], where: str, vertex_count: int) -> Polygons:
    """All polygons of a solid or surface geometry; of a solid only the outer shell, as nobody sees
    a cavity.

    where: names the geometry in errors. SceneError if the lists nest wrongly or an index is none
    of the vertices.
    """
    depth = _DEPTH[geometry["type"]]
    found = list(_walk(geometry.get("boundaries"), depth, (), where))
    rings = [polygon for _, polygon in found]
    _check_indices(rings, where, vertex_count)
    semantics = geometry.get("semantics")
    if semantics is None:
        return Polygons(rings, [Surface.UNKNOWN] * len(rings))
    try:
        return Polygons(rings, [_surface(semantics, place) for place, _ in found])
    except (KeyError, IndexError, TypeError):
        return Polygons(rings, [Surface.UNKNOWN] * len(rings), semantics_misfit=True)


def _walk(
    boundaries: object, depth: int, place: tuple[int, ...], where: str
) -> Iterator[tuple[tuple[int, ...], list[list[int]]]]:
    """Each polygon and its place in the nested lists."""
    if not isinstance(boundaries, list):
        at = "".join(f"[{index}]" for index in place)
        raise SceneError(f"{where}: boundaries{at}: must be a list")
    # The innermost list above polygons is a shell; shells after the first are cavities.
    items = boundaries[:1] if depth == 1 else boundaries
    for index, item in enumerate(items):
        if depth == 0:
            yield (*place, index), item
        else:
            yield from _walk(item, depth - 1, (*place, index), where)


def _check_indices(rings: list[list[list[int]]], where: str, vertex_count: int) -> None:
    try:
        flat = [index for polygon in rings for ring in polygon for index in ring]
        indices = np.array(flat) if flat else np.empty(0, np.int64)
    except (TypeError, ValueError) as error:
        raise SceneError(f"{where}: boundaries: lists nest too little or too deep") from error
    if indices.ndim != 1 or indices.dtype.kind != "i":
        raise SceneError(f"{where}: boundaries: a ring holds something that is no vertex index")
    outside = indices[(indices < 0) | (indices >= vertex_count)]
    if len(outside):
        raise SceneError(
            f"{where}: boundaries: vertex index {outside[0]} is none of the file's "
            f"{vertex_count} vertices"
        )
    if any(not polygon for polygon in rings):
        raise SceneError(f"{where}: boundaries: a surface without a ring")


def _surface(semantics: Mapping[str, Any], place: tuple[int, ...]) -> Surface:
    value = semantics["values"]
    for index in place:
        if value is None:
            return Surface.UNKNOWN
        value = value[index]
    if value is None:
        return Surface.UNKNOWN
    if value < 0:
        raise IndexError(value)
    return _SURFACES.get(semantics["surfaces"][value]["type"], Surface.OTHER)
