# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The prims of a stage that validation looks at, found in one walk, district by district."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, field

from pxr import Usd, UsdGeom, UsdLux

PREFIX = "Nightcity"
NAMESPACE = "nightcity"
# The type of prim that each schema belongs on; others go on any.
PRIM_TYPES = {
    "NightcityWindowsAPI": "PointInstancer",
    "NightcityMediaAPI": "Cube",
    "NightcityGroundAPI": "Mesh",
}
# Instances are looked into, because their windows and boxes are rendered too.
CHILDREN = Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)
# Those and the districts that are not loaded.
_CHILDREN_AND_DISTRICTS = Usd.TraverseInstanceProxies(
    Usd.PrimIsActive & Usd.PrimIsDefined & ~Usd.PrimIsAbstract
)


@dataclass
class Contents:
    """Prims of a stage, or of a piece of it, by schema.

    windows, media, grounds: of the right type with the schema applied. ours: every prim with one
    of our schemas or an attribute in our namespace. lights: there are UsdLux lights.
    """

    stage: Usd.Stage
    windows: list[Usd.Prim] = field(default_factory=list)
    media: list[Usd.Prim] = field(default_factory=list)
    grounds: list[Usd.Prim] = field(default_factory=list)
    cities: list[Usd.Prim] = field(default_factory=list)
    buildings: list[Usd.Prim] = field(default_factory=list)
    ours: list[Usd.Prim] = field(default_factory=list)
    cameras: int = 0
    lights: int = 0
    metres: float = 1.0  # per stage unit; 1 where the stage has no sensible value


def read_contents(top: Usd.Prim, districts: Collection[str] = ()) -> list[Contents]:
    """Walk what is active, loaded and defined from ``top`` down, without ``districts``.

    Cut where a district lies: one piece before the first, one after each, in the stage's order.
    """
    pieces = [_nothing_of(top.GetStage())]
    walk = iter(Usd.PrimRange(top, _CHILDREN_AND_DISTRICTS))
    for prim in walk:
        if districts and str(prim.GetPath()) in districts:
            walk.PruneChildren()
            pieces.append(_nothing_of(top.GetStage()))
        else:
            _sort_in(prim, pieces[-1])
    return pieces


def _nothing_of(stage: Usd.Stage) -> Contents:
    metres = UsdGeom.GetStageMetersPerUnit(stage)
    return Contents(stage, metres=metres if 0 < metres < math.inf else 1.0)


def _sort_in(prim: Usd.Prim, contents: Contents) -> None:
    places = {
        "NightcityWindowsAPI": contents.windows,
        "NightcityMediaAPI": contents.media,
        "NightcityGroundAPI": contents.grounds,
        "NightcityCityAPI": contents.cities,
        "NightcityBuildingAPI": contents.buildings,
    }
    if prim.IsA(UsdGeom.Camera):
        contents.cameras += 1
    elif prim.HasAPI(UsdLux.LightAPI):
        contents.lights += 1
    applied = [name for name in authored_schemas(prim) if name.startswith(PREFIX)]
    if applied or prim.GetAuthoredPropertiesInNamespace(NAMESPACE):
        contents.ours.append(prim)
    for name in applied:
        wanted = PRIM_TYPES.get(name)
        if name in places and (wanted is None or prim.GetTypeName() == wanted):
            places[name].append(prim)


def authored_schemas(prim: Usd.Prim) -> list[str]:
    """Names of the applied schemas, those that USD does not know included."""
    applied = prim.GetMetadata("apiSchemas")
    return list(applied.GetAppliedItems()) if applied else []
