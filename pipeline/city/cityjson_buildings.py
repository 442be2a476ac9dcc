# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Which geometry of a CityJSON file makes up which building, at which level of detail.

A building is a Building object with all BuildingParts below it. Every one of these bodies gives
the geometry of one level of detail. Where a Building and its parts both have geometry, whether
its own is one body more or a hull around its parts is decided by town_meshes, which sees shapes.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from nightcity.city.cityjson import CityJson
from nightcity.city.cityjson_geometry import SOLIDS, SURFACES, Polygons, polygons
from nightcity.city.town_options import FINEST
from nightcity.errors import SceneError

_BODIES = ("Building", "BuildingPart")
_SUPPORTED = SOLIDS + SURFACES


@dataclass(frozen=True)
class Body:
    """The geometry of one Building or BuildingPart. solid: it claims to be closed."""

    name: str
    polygons: tuple[Polygons, ...]
    solid: bool


@dataclass(frozen=True)
class SourceBuilding:
    """A building as the file has it. own: the Building's geometry, or None; parts: its parts'."""

    name: str
    own: Body | None
    parts: tuple[Body, ...]


def source_buildings(file: CityJson, lod: str, notes: Counter[str]) -> list[SourceBuilding]:
    """The buildings that have geometry, in the file's order.

    lod: a number as text, or "finest". notes: counts what is left out. SceneError if there is no
    building, or none at this level of detail.
    """
    _note_what_is_left_out(file, notes)
    families = _families(file, notes)
    if not families:
        raise SceneError(f"{file.path}: CityObjects: there is no Building")
    found = [_source_building(file, names, lod, notes) for names in families]
    buildings = [building for building in found if building is not None]
    if not buildings:
        levels = sorted({level for names in families for level in _levels(file, names)})
        there = ", ".join(f"{level:g}" for level in levels) or "none at all"
        wanted = "" if lod == FINEST else f" at level of detail {lod}"
        raise SceneError(
            f"{file.path}: no building has solid or surface geometry{wanted}; levels there: {there}"
        )
    return buildings


def _note_what_is_left_out(file: CityJson, notes: Counter[str]) -> None:
    for name, item in file.objects.items():
        if item["type"] not in _BODIES:
            notes[f"objects of type {item['type']}, no buildings, left out"] += 1
            continue
        for _, geometry in _geometries(file, name):
            if (kind := geometry.get("type")) not in _SUPPORTED:
                notes[f"geometries of type {kind}, not supported, left out"] += 1


def _families(file: CityJson, notes: Counter[str]) -> list[tuple[str, ...]]:
    """The ids of each building: the Building, then the BuildingParts below it.

    A part that no Building names as its child is put with the parent it names, or is a building
    of its own.
    """
    claimed: dict[str, str] = {}  # part -> its building
    members: dict[str, list[str]] = {}
    for name, item in file.objects.items():
        if item["type"] == "Building":
            members[name] = [name]
            for part in _parts_below(file, name, notes):
                if claimed.setdefault(part, name) == name:
                    members[name].append(part)
                else:
                    notes["BuildingParts with two parents, put with the first"] += 1
    for name, item in file.objects.items():
        if item["type"] == "BuildingPart" and name not in claimed:
            parent = next((p for p in _ids(file, name, "parents") if p in members), name)
            if parent == name:
                notes["BuildingParts without a parent, taken as buildings"] += 1
            members.setdefault(parent, []).append(name)
    return [tuple(names) for names in members.values()]


def _parts_below(file: CityJson, name: str, notes: Counter[str]) -> Iterator[str]:
    """The BuildingParts that are children of an object, and theirs, each once."""
    pending, seen = [name], {name}
    while pending:
        for child in _ids(file, pending.pop(0), "children"):
            if child not in file.objects:
                notes["children of buildings that are not in the file, left out"] += 1
            elif child not in seen and file.objects[child]["type"] == "BuildingPart":
                seen.add(child)
                pending.append(child)
                yield child


def _ids(file: CityJson, name: str, field: str) -> list[str]:
    ids = file.objects[name].get(field) or []
    if not isinstance(ids, list) or not all(isinstance(item, str) for item in ids):
        raise SceneError(f"{file.path}: CityObjects[{name!r}].{field}: must be a list of ids")
    return ids


def _source_building(
    file: CityJson, names: tuple[str, ...], lod: str, notes: Counter[str]
) -> SourceBuilding | None:
    levels = _levels(file, names)
    if not levels:
        notes["buildings without solid or surface geometry, left out"] += 1
        return None
    if lod != FINEST and float(lod) not in levels:
        notes[f"buildings without level of detail {lod}, left out"] += 1
        return None
    wanted = max(levels) if lod == FINEST else float(lod)
    bodies = [_body(file, name, wanted, notes) for name in names]
    own = bodies.pop(0) if file.objects[names[0]]["type"] == "Building" else None
    if lod == FINEST:  # a part that is only there in less detail still fills its place
        bodies = [
            body or _body(file, name, max(_levels(file, (name,)), default=wanted), notes)
            for body, name in zip(bodies, names[-len(bodies) :] if bodies else (), strict=True)
        ]
    return SourceBuilding(names[0], own, tuple(body for body in bodies if body is not None))


def _levels(file: CityJson, names: tuple[str, ...]) -> set[float]:
    """The levels of detail at which these objects have geometry that can be used."""
    return {
        _level(geometry, where)
        for name in names
        for where, geometry in _geometries(file, name)
        if geometry.get("type") in _SUPPORTED
    }


def _geometries(file: CityJson, name: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Each geometry of an object, with the words that name it in messages."""
    where = f"{file.path}: CityObjects[{name!r}].geometry"
    geometries = file.objects[name].get("geometry") or []
    if not isinstance(geometries, list):
        raise SceneError(f"{where}: must be a list")
    for index, geometry in enumerate(geometries):
        if not isinstance(geometry, dict):
            raise SceneError(f"{where}[{index}]: no JSON object")
        yield f"{where}[{index}]", geometry


def _level(geometry: Mapping[str, Any], where: str) -> float:
    """A number in CityJSON 1.0, text since."""
    lod = geometry.get("lod")
    try:
        level = float(lod) if isinstance(lod, str | int | float) else math.nan
    except ValueError:
        level = math.nan
    if isinstance(lod, bool) or not math.isfinite(level):
        raise SceneError(f"{where}: lod: {lod!r} is no level of detail")
    return level


def _body(file: CityJson, name: str, level: float, notes: Counter[str]) -> Body | None:
    """An object's geometry at a level: its solids, or its surfaces where it has no solid."""
    at_level = []
    for where, geometry in _geometries(file, name):
        if geometry.get("type") in _SUPPORTED and _level(geometry, where) == level:
            at_level.append((where, geometry))
    solids = [pair for pair in at_level if pair[1]["type"] in SOLIDS]
    taken = [
        polygons(geometry, where, len(file.vertices)) for where, geometry in solids or at_level
    ]
    taken = [found for found in taken if found.rings]
    misfits = sum(found.semantics_misfit for found in taken)
    if misfits:
        notes["geometries whose semantics do not fit, walls told by normals"] += misfits
    return Body(name, tuple(taken), bool(solids)) if taken else None
