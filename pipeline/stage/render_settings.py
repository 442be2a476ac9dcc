# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""UsdRender settings: the frame size, the camera and the channels of a picture."""

from __future__ import annotations

from pxr import Gf, Sdf

from nightcity.city.model import City
from nightcity.stage import layout
from nightcity.stage.attributes import PrimWriter

SETTINGS = layout.RENDER.AppendChild("Settings")
_CHANNELS = (
    ("beauty", "color3f"),
    ("glow", "color3f"),
    ("surface", "color3f"),
    ("transmittance", "float"),
    ("depth", "float"),
    ("normal", "normal3f"),
    ("mediaId", "float"),
    ("materialId", "float"),
)


def write_render_settings(city: City, layer: Sdf.Layer) -> None:
    """Write /Render into the root layer and point the stage at it."""
    render = PrimWriter(layer, layout.RENDER.name, "Scope")
    channels = []
    holder = PrimWriter(render, "Channels", "Scope")
    for name, data_type in _CHANNELS:
        channel = PrimWriter(holder, name, "RenderVar")
        channel.set("dataType", data_type)
        channel.set("sourceName", name)
        channels.append(channel.path)
    product = PrimWriter(PrimWriter(render, "Products", "Scope"), "frame", "RenderProduct")
    product.set("productType", "raster")
    product.set("productName", "frame.####.exr")
    product.relate("orderedVars", channels)
    settings = PrimWriter(render, SETTINGS.name, "RenderSettings")
    settings.set("resolution", Gf.Vec2i(*map(int, city.resolution)))
    settings.set("includedPurposes", ["default", "render"])
    settings.relate("products", [product.path])
    if city.cameras:
        settings.relate("camera", [layout.camera_path(city.cameras[0])])
    layer.pseudoRoot.SetInfo("renderSettingsPrimPath", str(SETTINGS))
