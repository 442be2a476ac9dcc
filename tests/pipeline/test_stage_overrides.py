# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The override that docs/usdview.md shows works as it says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from pxr import Gf, Usd, UsdGeom
from stage_city import small_city

from nightcity.stage.validate import validate_stage
from nightcity.stage.write import write_stage

PAGE = Path(__file__).parents[2] / "docs" / "usdview.md"


@pytest.fixture
def shot(tmp_path: Path) -> Path:
    write_stage(small_city(), tmp_path / "city.usda")
    (layer,) = re.findall(r"```usda\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    (tmp_path / "shot.usda").write_text(layer)
    return tmp_path / "shot.usda"


def test_the_changes_of_the_page_arrive(shot: Path) -> None:
    stage = Usd.Stage.Open(str(shot))
    group = "/City/Buildings/Group_0000"
    windows = stage.GetPrimAtPath(f"{group}/Building_0/Windows")
    world = UsdGeom.XformCache().GetLocalToWorldTransform(windows)
    assert world.ExtractTranslation() == Gf.Vec3d(-5, 40, 0)
    dark = stage.GetPrimAtPath(f"{group}/Building_1/Windows").GetAttribute("nightcity:lightOn")
    assert list(dark.Get()) == [False]
    box = stage.GetPrimAtPath("/City/Media/Group_0000/Box_0")
    assert box.GetAttribute("nightcity:extinction").Get() == pytest.approx(0.05)
    assert box.GetAttribute("nightcity:albedo").Get() == pytest.approx(0.9)
    roof = UsdGeom.Camera.Get(stage, "/City/Cameras/roof").GetCamera(0)
    assert roof.GetFieldOfView(Gf.Camera.FOVVertical) == pytest.approx(37.8, abs=0.1)
    assert roof.aspectRatio == pytest.approx(1920 / 1061, rel=1e-3)
    assert stage.GetPrimAtPath("/City/Cameras/overview")


def test_validation_says_what_the_page_says(shot: Path) -> None:
    findings = validate_stage(shot)
    assert {(each.severity, each.attribute) for each in findings} == {
        ("warning", "protoIndices"),
        ("warning", "nightcity:windowLights"),
    }
