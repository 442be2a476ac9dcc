# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Cameras over frames, and the render settings."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from export_maker import SQUARE, add_mesh, export, new_stage
from numpy.testing import assert_allclose
from pxr import Gf, Usd, UsdGeom, UsdRender

from nightcity.errors import SceneError


def add_camera(stage: Usd.Stage, path: str, **attributes: object) -> UsdGeom.Camera:
    camera = UsdGeom.Camera.Define(stage, path)
    values = {"focalLength": 50, "horizontalAperture": 40, "verticalAperture": 20} | attributes
    for name, value in values.items():
        camera.GetPrim().GetAttribute(name).Set(value)
    return camera


def test_every_field_of_a_camera(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    camera = add_camera(stage, "/Cam", horizontalApertureOffset=5, verticalApertureOffset=-2)
    camera.AddTranslateOp().Set((1, 2, 3))
    camera.AddRotateXOp().Set(90)  # looks along +y, up is z
    scene = export(stage, tmp_path / "s")
    record = scene["camera_frame"][0]
    assert_allclose(record["position"], (1, 2, 3))
    assert_allclose(record["forward"], (0, 1, 0), atol=1e-7)
    assert_allclose(record["up"], (0, 0, 1), atol=1e-7)
    assert_allclose(record["right"], (1, 0, 0), atol=1e-7)
    assert_allclose(record["tan_half_fov"], 0.2)
    assert_allclose((record["shift_x"], record["shift_y"]), (0.5, -0.2))
    assert record["aspect"] == 2
    assert scene.manifest["cameras"] == [
        {"name": "Cam", "prim": "/Cam", "first_frame": 1, "first": 0, "count": 1}
    ]


@pytest.mark.parametrize("up", ["Y", "Z"])
def test_the_ray_through_a_pixel_is_that_of_usd(tmp_path: Path, up: str) -> None:
    """The formula of docs/scene_format.md against Gf.Frustum, with lens shift, in metres, z up."""
    stage = new_stage(tmp_path / "a.usda", up=up, unit=0.01)
    camera = add_camera(stage, "/Cam", horizontalApertureOffset=3, verticalApertureOffset=4)
    camera.AddTranslateOp().Set((100, 200, 300))
    camera.AddRotateXYZOp().Set((20, -35, 50))
    scene = export(stage, tmp_path / "s")
    record = scene["camera_frame"][0].copy()
    width, height, x, y = 400, 200, 37.5, 181.5
    tangent = record["tan_half_fov"]
    across = tangent * (2 * x - width) / height + tangent * record["shift_x"]
    upward = tangent * (height - 2 * y) / height + tangent * record["shift_y"]
    direction = record["forward"] + across * record["right"] + upward * record["up"]

    frustum = camera.GetCamera(Usd.TimeCode(1)).frustum
    ray = frustum.ComputePickRay(Gf.Vec2d(2 * x / width - 1, 1 - 2 * y / height))
    start = 0.01 * np.array(frustum.position)
    expected = np.array(ray.direction)
    if up == "Y":
        start, expected = ((v[0], -v[2], v[1]) for v in (start, expected))
    assert_allclose(record["position"], start, rtol=1e-6)
    assert_allclose(direction / np.linalg.norm(direction), expected, atol=1e-6)


def test_a_camera_that_moves_and_one_that_does_not(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    rig = UsdGeom.Xform.Define(stage, "/Rig").AddTranslateOp()
    rig.Set((0, 0, 0), 10)
    rig.Set((8, 0, 0), 14)
    add_camera(stage, "/Rig/Moving")
    zoom = add_camera(stage, "/Zoom").GetFocalLengthAttr()
    zoom.Set(50, 10)
    zoom.Set(100, 14)
    add_camera(stage, "/Fixed")
    still = add_camera(stage, "/Still").AddTranslateOp()
    still.Set((1, 0, 0), 10)
    still.Set((1, 0, 0), 14)  # samples, but no movement
    stage.SetStartTimeCode(11)
    stage.SetEndTimeCode(13)
    scene = export(stage, tmp_path / "s")
    entries = {entry["name"]: entry for entry in scene.manifest["cameras"]}
    assert {name: entry["count"] for name, entry in entries.items()} == {
        "Moving": 3, "Zoom": 3, "Fixed": 1, "Still": 1,
    }  # fmt: skip
    assert {entry["first_frame"] for entry in entries.values()} == {11}
    frames = scene["camera_frame"]
    moving = frames[entries["Moving"]["first"] :][:3]
    assert moving["position"][:, 0].tolist() == [2, 4, 6]
    zooming = frames[entries["Zoom"]["first"] :][:3]
    assert_allclose(zooming["tan_half_fov"], [10 / 62.5, 10 / 75, 10 / 87.5])


def test_names_are_unique(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    for path in ("/A/Cam", "/B/Cam", "/B/Other"):
        add_camera(stage, path)
    names = [entry["name"] for entry in export(stage, tmp_path / "s").manifest["cameras"]]
    assert names == ["/A/Cam", "/B/Cam", "Other"]


def test_what_a_camera_cannot_be(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_camera(stage, "/Ortho", projection="orthographic")
    add_camera(stage, "/Blurred", fStop=2.8)
    mirrored = add_camera(stage, "/Mirrored")
    mirrored.AddScaleOp().Set((-1, 1, 1))
    scene = export(stage, tmp_path / "s")
    assert "Orthographic cameras are left out: /Ortho." in scene.notes
    assert "every camera is a pinhole: /Blurred." in scene.notes
    assert "A mirrored camera is taken unmirrored: /Mirrored." in scene.notes
    assert [entry["name"] for entry in scene.manifest["cameras"]] == ["Blurred", "Mirrored"]
    for record in scene["camera_frame"]:
        assert_allclose(np.cross(record["right"], record["up"]), -record["forward"], atol=1e-7)


@pytest.mark.parametrize("name", ["focalLength", "verticalAperture", "horizontalAperture"])
@pytest.mark.parametrize("value", [0, -1, math.nan])
def test_lenses_that_are_none(tmp_path: Path, name: str, value: float) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_camera(stage, "/Cam", **{name: value})
    with pytest.raises(SceneError, match="/Cam: at frame 1 its focal length and apertures"):
        export(stage, tmp_path / "s")


def test_a_flat_transform(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_camera(stage, "/Cam").AddScaleOp().Set((1, 1, 0))
    with pytest.raises(SceneError, match="/Cam: its transform at frame 1 is flat"):
        export(stage, tmp_path / "s")


def test_hidden_cameras_still_see(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_camera(stage, "/Rig/Cam")
    UsdGeom.Xform.Define(stage, "/Rig").MakeInvisible()
    assert len(export(stage, tmp_path / "s").manifest["cameras"]) == 1


def test_render_settings(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    for name in ("One", "Two"):
        add_camera(stage, f"/{name}")
    assert export(stage, tmp_path / "s").manifest["render"] == {
        "camera": None, "width": 0, "height": 0, "aovs": [],
    }  # fmt: skip
    settings = UsdRender.Settings.Define(stage, "/Render/Settings")
    settings.CreateResolutionAttr(Gf.Vec2i(640, 360))
    settings.CreateCameraRel().SetTargets(["/One"])
    product = UsdRender.Product.Define(stage, "/Render/Product")
    settings.CreateProductsRel().SetTargets(["/Render/Product"])
    for name, source in (("beauty", None), ("haze", "glow")):
        var = UsdRender.Var.Define(stage, f"/Render/{name}")
        if source:
            var.CreateSourceNameAttr(source)
    product.CreateOrderedVarsRel().SetTargets(["/Render/beauty", "/Render/haze"])
    found = export(stage, tmp_path / "s").manifest["render"]
    assert found == {"camera": "One", "width": 640, "height": 360, "aovs": ["beauty", "glow"]}
    product.CreateResolutionAttr(Gf.Vec2i(100, 50))
    product.CreateCameraRel().SetTargets(["/Two"])
    found = export(stage, tmp_path / "s").manifest["render"]
    assert (found["camera"], found["width"], found["height"]) == ("Two", 100, 50)


def test_render_settings_that_point_nowhere(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_mesh(stage, "/M", *SQUARE)
    settings = UsdRender.Settings.Define(stage, "/Render/Settings")
    settings.CreateCameraRel().SetTargets(["/Gone"])
    scene = export(stage, tmp_path / "s")
    assert scene.manifest["render"]["camera"] is None
    assert "name the camera /Gone, which is not exported." in scene.notes
    settings.CreateResolutionAttr(Gf.Vec2i(0, 50))
    with pytest.raises(SceneError, match=r"/Render/Settings.resolution is 0 x 50"):
        export(stage, tmp_path / "s")
