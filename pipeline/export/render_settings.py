# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The stage's UsdRender settings: camera, frame size and channels."""

from __future__ import annotations

from collections.abc import Sequence

from pxr import Usd, UsdRender

from nightcity.errors import SceneError
from nightcity.export.open_stage import Source


def read_render_settings(source: Source, cameras: Sequence[dict]) -> dict:
    """The manifest's ``render``. cameras: its ``cameras``.

    The settings are those that the stage's renderSettingsPrimPath names, or the first on the
    stage; a product's own camera and resolution win over theirs, as UsdRender has it.
    """
    settings = _settings(source)
    if settings is None:
        return {"camera": None, "width": 0, "height": 0, "aovs": []}
    products = [
        prim
        for path in settings.GetRelationship("products").GetForwardedTargets()
        if (prim := source.stage.GetPrimAtPath(path)) and prim.IsA(UsdRender.Product)
    ]
    if len(products) > 1:
        source.notes.about("Render products after the first are left out", products[1].GetPath())
    holders = [*products[:1], settings]
    width, height = _resolution(source, holders)
    return {
        "camera": _camera(source, holders, cameras),
        "width": width,
        "height": height,
        "aovs": _channels(source, products[0]) if products else [],
    }


def _settings(source: Source) -> Usd.Prim | None:
    stage = source.stage
    named = UsdRender.Settings.GetStageRenderSettings(stage)
    if named:
        return named.GetPrim()
    found = [prim for prim in stage.Traverse() if prim.IsA(UsdRender.Settings)]
    if len(found) > 1:
        source.notes.say(
            "The stage names none of its render settings as its own;"
            f" the first is taken: {found[0].GetPath()}"
        )
    return found[0] if found else None


def _resolution(source: Source, holders: Sequence[Usd.Prim]) -> tuple[int, int]:
    for prim in holders:
        attribute = prim.GetAttribute("resolution")
        if not attribute.HasAuthoredValue():
            continue
        width, height = (int(value) for value in attribute.Get(source.time))
        if width <= 0 or height <= 0:
            raise SceneError(f"{attribute.GetPath()} is {width} x {height}; both must be above 0")
        if prim.GetAttribute("pixelAspectRatio").Get(source.time) != 1:
            source.notes.about("Pixels are square, whatever pixelAspectRatio says", prim.GetPath())
        return width, height
    return 0, 0


def _camera(source: Source, holders: Sequence[Usd.Prim], cameras: Sequence[dict]) -> str | None:
    for prim in holders:
        for path in prim.GetRelationship("camera").GetForwardedTargets():
            for camera in cameras:
                if camera["prim"] == str(path):
                    return camera["name"]
            source.notes.say(
                f"The render settings {prim.GetPath()} name the camera {path},"
                " which is not exported"
            )
    return None


def _channels(source: Source, product: Usd.Prim) -> list[str]:
    names = []
    for path in product.GetRelationship("orderedVars").GetForwardedTargets():
        var = source.stage.GetPrimAtPath(path)
        if var:
            names.append(str(var.GetAttribute("sourceName").Get() or var.GetName()))
    return names
