# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The root layer: what the stage is made of, the city's own attributes, the render settings."""

from __future__ import annotations

import json

from pxr import Gf, Sdf

from nightcity.city.model import City
from nightcity.stage import layout
from nightcity.stage.attributes import PrimWriter
from nightcity.stage.render_settings import write_render_settings

_DOCUMENTATION = """A city at night for the Nightcity renderer: right-handed, z up, metres, watts.

Each sublayer holds one thing and can be overridden above, muted or exchanged on its own: cameras,
media (haze), windows, geometry. A large city keeps the last three in districts, each
a payload with such sublayers of its own. The attributes named nightcity:... are built-in where
PXR_PLUGINPATH_NAME names the folder of Nightcity's schemas, and readable everywhere."""


def write_root(city: City, layer: Sdf.Layer, sublayers: list[str]) -> None:
    """Write the root layer over ``sublayers``, file names beside it, the strongest first."""
    layer.documentation = _DOCUMENTATION
    layer.startTimeCode, layer.endTimeCode = 1.0, float(city.frames)
    layer.framesPerSecond = layer.timeCodesPerSecond
    _stack(layer, sublayers)
    root = layout.city_prim(layer, ["NightcityCityAPI"])
    root.spec.kind = "assembly"
    root.spec.SetInfo("displayName", city.name)
    root.set("nightcity:originOffset", Gf.Vec3d(*map(float, city.origin_offset)))
    root.set("nightcity:crs", city.crs)
    root.set("nightcity:parameters", json.dumps(dict(city.parameters), sort_keys=True))
    if city.notes:
        root.spec.comment = "\n".join(city.notes)
    write_render_settings(city, layer)


def write_district(layer: Sdf.Layer, sublayers: list[str]) -> None:
    """Write the root layer of a district over ``sublayers``; it can be opened on its own."""
    _stack(layer, sublayers)
    layout.city_prim(layer)


def write_districts(layer: Sdf.Layer, files: list[str]) -> None:
    """Write a prim for each district, with its file, relative to the layer's, as its payload."""
    holder = PrimWriter(layout.city_prim(layer), layout.DISTRICTS.name, "Xform")
    holder.spec.kind = "group"
    for index, file in enumerate(files):
        name = layout.district_name(index)
        prim = PrimWriter(holder, name, "Xform", ["NightcityDistrictAPI"])
        prim.spec.kind = "group"
        prim.spec.payloadList.prependedItems = [Sdf.Payload(f"./{file}")]


def _stack(layer: Sdf.Layer, sublayers: list[str]) -> None:
    for name in sublayers:
        layer.subLayerPaths.append(f"./{name}")
