# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Small CityJSON documents for tests, and where the excerpts lie."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

DATA = Path(__file__).parents[1] / "data"
DELFT = DATA / "delft-excerpt.city.json"
DENHAAG = DATA / "denhaag-excerpt.city.json"

Ring = list[tuple[float, float, float]]


class TownFile:
    """Collects objects and their vertices; ``write`` makes a CityJSON file of them."""

    def __init__(self, version: str = "2.0") -> None:
        self.version = version
        self.objects: dict[str, Any] = {}
        self.vertices: list[list[float]] = []

    def ring(self, ring: Ring) -> list[int]:
        """Adds vertices, returns their indices."""
        start = len(self.vertices)
        self.vertices += [list(map(float, point)) for point in ring]
        return list(range(start, len(self.vertices)))

    def add(self, name: str, faces: Sequence[Sequence[Ring]], **more: Any) -> dict[str, Any]:
        """A Building of faces, each an outer ring and holes. more: ``type`` and ``lod`` and
        ``kind`` (of geometry), and further fields of the object. Returns the geometry."""
        kind, lod = more.pop("kind", "Solid"), more.pop("lod", "1")
        surfaces = [[self.ring(ring) for ring in face] for face in faces]
        nested = {"Solid": [surfaces], "MultiSolid": [[surfaces]], "CompositeSolid": [[surfaces]]}
        geometry = {"type": kind, "lod": lod, "boundaries": nested.get(kind, surfaces)}
        item = self.objects.setdefault(name, {"type": "Building", "geometry": []})
        item["geometry"].append(geometry)
        item.update(more)
        return geometry

    def document(self) -> dict[str, Any]:
        """Vertices in millimetres under a transform, far from the origin as real files are."""
        document: dict[str, Any] = {
            "type": "CityJSON",
            "version": self.version,
            "CityObjects": self.objects,
            "vertices": self.vertices,
        }
        if self.version != "1.0":
            document["vertices"] = [[round(1000 * x) for x in v] for v in self.vertices]
            document["transform"] = {"scale": [0.001] * 3, "translate": [85000.0, 447000.0, 2.0]}
        return document

    def write(self, folder: Path, name: str = "town.city.json") -> Path:
        path = folder / name
        path.write_text(json.dumps(self.document()))
        return path


def box(
    lo: Sequence[float], hi: Sequence[float], *, floor: bool = True, roof: bool = True
) -> list[list[Ring]]:
    """The faces of a box, counter-clockwise seen from outside: four walls (south, east, north,
    west), roof, floor."""
    (x0, y0, z0), (x1, y1, z1) = lo, hi
    plan = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    faces = [
        [[(*a, z0), (*b, z0), (*b, z1), (*a, z1)]]
        for a, b in zip(plan, plan[1:] + plan[:1], strict=True)
    ]
    if roof:
        faces.append([[(*p, z1) for p in plan]])
    if floor:
        faces.append([[(*p, z0) for p in reversed(plan)]])
    return faces


def house(
    lo: Sequence[float], hi: Sequence[float], ridge: float, *, split: bool = False
) -> list[list[Ring]]:
    """A box with a gable roof whose ridge runs along x at height ridge. split: the gable walls
    are cut into a rectangle and a triangle."""
    (x0, y0, z0), (x1, y1, z1) = lo, hi
    middle = 0.5 * (y0 + y1)
    south, east, north, west = box(lo, hi, floor=False, roof=False)
    tops = [(x1, middle, ridge), (x0, middle, ridge)]
    if split:
        gables = [
            east,
            west,
            [[(x1, y0, z1), (x1, y1, z1), tops[0]]],
            [[(x0, y1, z1), (x0, y0, z1), tops[1]]],
        ]
    else:
        gables = [
            [[(x1, y0, z0), (x1, y1, z0), (x1, y1, z1), tops[0], (x1, y0, z1)]],
            [[(x0, y1, z0), (x0, y0, z0), (x0, y0, z1), tops[1], (x0, y1, z1)]],
        ]
    roofs = [
        [[(x0, y0, z1), (x1, y0, z1), tops[0], tops[1]]],
        [[(x1, y1, z1), (x0, y1, z1), tops[1], tops[0]]],
    ]
    return [south, north, *gables, *roofs]
