# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The prims of a stage that validation looks at, found in one walk."""

from __future__ import annotations

import math
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
_CHILDREN = Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)


@dataclass
class Contents:
    """A stage and its prims by schema.

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


def read_contents(stage: Usd.Stage) -> Contents:
    """Walk the stage: everything active, loaded and defined."""
    metres = UsdGeom.GetStageMetersPerUnit(stage)
    contents = Contents(stage, metres=metres if 0 < metres < math.inf else 1.0)
    places = {
        "NightcityWindowsAPI": contents.windows,
        "NightcityMediaAPI": contents.media,
        "NightcityGroundAPI": contents.grounds,
        "NightcityCityAPI": contents.cities,
        "NightcityBuildingAPI": contents.buildings,
    }
    for prim in Usd.PrimRange(stage.GetPseudoRoot(), _CHILDREN):
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
    return contents


def authored_schemas(prim: Usd.Prim) -> list[str]:
    """Names of the applied schemas, those that USD does not know included."""
    applied = prim.GetMetadata("apiSchemas")
    return list(applied.GetAppliedItems()) if applied else []
