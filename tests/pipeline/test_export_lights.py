# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A stage's own UsdLux lights: emitters of the same power, or a note that names them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from export_maker import add_windows, export, new_stage
from numpy.testing import assert_allclose
from pxr import UsdGeom, UsdLux

from nightcity.errors import SceneError


def test_a_rectangle_light(tmp_path: Path) -> None:
    """Power is pi A L; it shines along -z."""
    stage = new_stage(tmp_path / "a.usda", unit=0.01)
    add_windows(stage, "/W", [(0, 0, 0)], ids=[5])
    light = UsdLux.RectLight.Define(stage, "/Sign")
    light.CreateWidthAttr(400)
    light.CreateHeightAttr(200)
    light.CreateIntensityAttr(3)
    light.CreateExposureAttr(2)
    light.CreateColorAttr((1, 0.5, 0.25))
    light.AddTranslateOp().Set((100, 0, 500))
    sign = export(stage, tmp_path / "s")["window"][1]
    assert_allclose(sign["centre"], (1, 0, 5))
    assert_allclose(np.linalg.norm(sign["half_u"]), 2)
    assert_allclose(np.linalg.norm(sign["half_v"]), 1)
    assert_allclose(np.cross(sign["half_u"], sign["half_v"]), (0, 0, -2), atol=1e-6)
    assert_allclose(sign["power"], math.pi * 8 * 3 * 2**2, rtol=1e-6)
    assert sign["colour"].tolist() == [1, 0.5, 0.25]
    assert (sign["building"], sign["flags"], sign["window_id"]) == (0xFFFFFFFF, 1, 6)


@pytest.mark.parametrize("scale", [(-1, 1, 1), (1, 1, -1)])
def test_a_mirrored_rectangle_keeps_its_side(tmp_path: Path, scale: tuple[int, int, int]) -> None:
    stage = new_stage(tmp_path / "a.usda")
    UsdLux.RectLight.Define(stage, "/Sign").AddScaleOp().Set(scale)
    sign = export(stage, tmp_path / "s")["window"][0]
    assert np.cross(sign["half_u"], sign["half_v"])[2] * scale[2] < 0


def test_normalize_makes_the_power_independent_of_size(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    for number, width in enumerate((0.5, 8)):
        light = UsdLux.RectLight.Define(stage, f"/L{number}")
        light.CreateWidthAttr(width)
        light.CreateIntensityAttr(7)
        light.CreateNormalizeAttr(True)
    assert_allclose(export(stage, tmp_path / "s")["window"]["power"], [7 * math.pi] * 2, rtol=1e-6)


def test_a_disk_becomes_a_square_of_equal_area(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    light = UsdLux.DiskLight.Define(stage, "/Disk")
    light.CreateRadiusAttr(3)
    light.CreateIntensityAttr(2)
    scene = export(stage, tmp_path / "s")
    disk = scene["window"][0]
    cross = np.cross(disk["half_u"], disk["half_v"])
    assert_allclose(4 * np.linalg.norm(cross), math.pi * 9, rtol=1e-6)
    assert cross[2] < 0
    assert_allclose(disk["power"], math.pi * math.pi * 9 * 2, rtol=1e-6)
    assert "A DiskLight becomes a square of equal area and power: /Disk." in scene.notes


def test_spheres(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    ball = UsdLux.SphereLight.Define(stage, "/Ball")
    ball.CreateRadiusAttr(0.5)
    ball.CreateIntensityAttr(2)
    ball.AddScaleOp().Set((4, 4, 4))
    point = UsdLux.SphereLight.Define(stage, "/Point")
    point.CreateTreatAsPointAttr(True)
    point.CreateIntensityAttr(2)
    squashed = UsdLux.SphereLight.Define(stage, "/Squashed")
    squashed.AddScaleOp().Set((8, 1, 1))
    scene = export(stage, tmp_path / "s")
    windows = scene["window"]
    assert windows["flags"].tolist() == [3, 3, 3]
    radii = np.linalg.norm(windows["half_u"], axis=1)
    assert_allclose(radii, [2, 1e-3, 1], rtol=1e-6)
    # pi A L, with the area that the light states, also where it is treated as a point.
    expected = [math.pi * 4 * math.pi * r**2 * 2 for r in (2, 0.5)]
    assert_allclose(windows["power"][:2], expected, rtol=1e-6)
    assert "becomes a ball of equal volume: /Squashed." in scene.notes
    cosine = np.einsum("ni,ni->n", windows["half_u"], windows["half_v"])
    assert (cosine == 0).all()


def test_colour_temperature(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    light = UsdLux.RectLight.Define(stage, "/L")
    light.CreateEnableColorTemperatureAttr(True)
    light.CreateColorTemperatureAttr(2700)
    light.CreateColorAttr((0.5, 1, 1))
    colour = export(stage, tmp_path / "s")["window"]["colour"][0]
    kelvin = np.array(UsdLux.BlackbodyTemperatureAsRgb(2700))
    assert_allclose(colour, kelvin * (0.5, 1, 1), rtol=1e-6)
    assert colour[0] > colour[2]


@pytest.mark.parametrize(
    "kind", ["DistantLight", "DomeLight", "CylinderLight", "GeometryLight", "PortalLight"]
)
def test_other_lights_are_named(tmp_path: Path, kind: str) -> None:
    stage = new_stage(tmp_path / "a.usda")
    stage.DefinePrim("/Other", kind)
    add_windows(stage, "/W", [(0, 0, 0)])
    scene = export(stage, tmp_path / "s")
    assert f"The {kind} /Other is left out" in scene.notes
    assert len(scene["window"]) == 1


def test_shaping_is_named(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    light = UsdLux.RectLight.Define(stage, "/L")
    plain = UsdLux.RectLight.Define(stage, "/Plain")
    for each in (light, plain):
        UsdLux.ShapingAPI.Apply(each.GetPrim())
    UsdLux.ShapingAPI(light).CreateShapingConeAngleAttr(30)
    UsdLux.ShapingAPI(light).CreateShapingIesFileAttr("lamp.ies")
    light.CreateTextureFileAttr("sign.png")
    notes = export(stage, tmp_path / "s").notes
    for name in ("shaping:cone:angle", "shaping:ies:file", "texture:file"):
        assert f"inputs:{name} of a light is left out: /L." in notes
    assert "/Plain" not in notes


def test_hidden_lights_are_off(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    UsdLux.RectLight.Define(stage, "/Hidden").MakeInvisible()
    blinking = UsdLux.RectLight.Define(stage, "/Blinking").CreateVisibilityAttr()
    blinking.Set("invisible", 1)
    blinking.Set("inherited", 4)
    scene = export(stage, tmp_path / "s", frames=(1, 9))
    assert scene["window"]["flags"].tolist() == [0]
    assert scene["window_event"].tolist() == [(4, 0, 1)]


@pytest.mark.parametrize("size", [0, -1, float("nan")])
def test_sizes_that_are_no_sizes(tmp_path: Path, size: float) -> None:
    stage = new_stage(tmp_path / "a.usda")
    UsdLux.RectLight.Define(stage, "/L").CreateWidthAttr(size)
    UsdGeom.Camera.Define(stage, "/C")
    if size == 0:
        assert (
            "The RectLight /L is left out: it has no surface."
            in export(stage, tmp_path / "s").notes
        )
    else:
        with pytest.raises(SceneError, match=r"/L.inputs:width is"):
            export(stage, tmp_path / "s")


@pytest.mark.parametrize("name", ["intensity", "exposure"])
def test_emission_that_is_not_finite(tmp_path: Path, name: str) -> None:
    stage = new_stage(tmp_path / "a.usda")
    light = UsdLux.SphereLight.Define(stage, "/L").GetPrim()
    light.GetAttribute(f"inputs:{name}").Set(float("nan"))
    with pytest.raises(SceneError, match="/L: intensity, exposure and color must be finite"):
        export(stage, tmp_path / "s")
