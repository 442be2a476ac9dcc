# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Where each thing of a city lies on the stage, the same for every layer."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TypeVar

from pxr import Sdf

from nightcity.city.model import Building, Camera, City, Material
from nightcity.stage.attributes import PrimWriter

GROUP_SIZE = 100  # siblings under one prim; viewers and the Usd API slow down with thousands
CITY = Sdf.Path("/City")
BUILDINGS = CITY.AppendChild("Buildings")
DISTRICTS = CITY.AppendChild("Districts")
MEDIA = CITY.AppendChild("Media")
LOOKS = CITY.AppendChild("Looks")
CAMERAS = CITY.AppendChild("Cameras")
RENDER = Sdf.Path("/Render")
WINDOW_LOOKS = CITY.AppendChild("WindowLooks")
WINDOW_PROTOTYPES = CITY.AppendChild("WindowPrototypes")

_Item = TypeVar("_Item")


def groups(items: Sequence[_Item]) -> Iterator[tuple[str, Sequence[_Item]]]:
    """Cut a sequence into named groups of at most GROUP_SIZE."""
    for index, start in enumerate(range(0, len(items), GROUP_SIZE)):
        yield f"Group_{index:04d}", items[start : start + GROUP_SIZE]


def district_name(index: int) -> str:
    return f"District_{index:04d}"


def building_name(building: Building) -> str:
    return f"Building_{building.building_id}"


def instancer_paths(city: City) -> list[Sdf.Path]:
    """The path of each building's window instancer, in the city's order."""
    return [
        BUILDINGS.AppendChild(group).AppendChild(building_name(building)).AppendChild("Windows")
        for group, members in groups(city.buildings)
        for building in members
    ]


def material_path(material: Material) -> Sdf.Path:
    return LOOKS.AppendChild(material.name)


def camera_path(camera: Camera) -> Sdf.Path:
    return CAMERAS.AppendChild(camera.name)


def new_layer(extension: str) -> Sdf.Layer:
    """An empty layer in memory with the city's conventions: z up, metres, 24 frames a second."""
    layer = Sdf.Layer.CreateAnonymous(f"layer.{extension}")
    layer.defaultPrim = CITY.name
    layer.pseudoRoot.SetInfo("upAxis", "Z")
    layer.pseudoRoot.SetInfo("metersPerUnit", 1.0)
    layer.timeCodesPerSecond = 24.0
    return layer


def city_prim(layer: Sdf.Layer, schemas: Sequence[str] = ()) -> PrimWriter:
    """/City, which every layer defines, so that each can be opened alone."""
    return PrimWriter(layer, CITY.name, "Xform", schemas)
