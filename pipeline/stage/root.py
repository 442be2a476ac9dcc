# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The root layer: what the stage is made of, the city's own attributes, the render settings."""

from __future__ import annotations

import json

from pxr import Gf, Sdf

from nightcity.city.model import City
from nightcity.stage import layout
from nightcity.stage.render_settings import write_render_settings

_DOCUMENTATION = """A city at night for the Nightcity renderer: right-handed, z up, metres, watts.

Each sublayer holds one thing and can be overridden above, muted or exchanged on its own: cameras,
media (haze), windows, geometry. The attributes named nightcity:... are built-in where
PXR_PLUGINPATH_NAME names the folder of Nightcity's schemas, and readable everywhere."""


def write_root(city: City, layer: Sdf.Layer, sublayers: list[str]) -> None:
    """Write the root layer over ``sublayers``, file names beside it, the strongest first."""
    layer.documentation = _DOCUMENTATION
    layer.startTimeCode = layer.endTimeCode = 1.0
    layer.framesPerSecond = layer.timeCodesPerSecond
    for name in sublayers:
        layer.subLayerPaths.append(f"./{name}")
    root = layout.city_prim(layer, ["NightcityCityAPI"])
    root.spec.kind = "assembly"
    root.spec.SetInfo("displayName", city.name)
    root.set("nightcity:originOffset", Gf.Vec3d(*map(float, city.origin_offset)))
    root.set("nightcity:crs", city.crs)
    root.set("nightcity:parameters", json.dumps(dict(city.parameters), sort_keys=True))
    if city.notes:
        root.spec.comment = "\n".join(city.notes)
    write_render_settings(city, layer)
