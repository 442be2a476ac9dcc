# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Media boxes, and the light lists that go with them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from export_maker import (
    SQUARE,
    add_box,
    add_building,
    add_mesh,
    add_windows,
    export,
    new_stage,
)
from numpy.testing import assert_allclose
from pxr import Usd, UsdGeom, UsdLux, Vt

from nightcity.errors import SceneError
from nightcity.export.media import snapped


def test_every_field_of_a_box(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_box(stage, "/M", 4, (-5, -6, 0), (5, 6, 30), extinction=0.02, albedo=0.5)
    box = export(stage, tmp_path / "s")["media_box"][0]
    assert (box["lo"].tolist(), box["hi"].tolist()) == ([-5, -6, 0], [5, 6, 30])
    assert (box["extinction"], box["albedo"]) == (np.float32(0.02), 0.5)
    assert (box["media_id"], box["light_count"], box["reserved"]) == (4, 0, 0)


def test_defaults_of_the_schema(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_box(stage, "/M", 0)
    box = export(stage, tmp_path / "s")["media_box"][0]
    assert (box["extinction"], box["albedo"]) == (np.float32(0.01), np.float32(0.9))


@pytest.mark.parametrize("turns", [(90, 0, 0), (0, -90, 0), (90, 180, 270)])
def test_quarter_turns_and_mirrors(tmp_path: Path, turns: tuple[float, float, float]) -> None:
    stage = new_stage(tmp_path / "a.usda")
    outer = UsdGeom.Xform.Define(stage, "/A")
    outer.AddRotateXYZOp().Set(turns)
    outer.AddScaleOp().Set((1, -1, 2))
    add_box(stage, "/A/M", 0, (1, 2, 3), (2, 4, 6))
    box = export(stage, tmp_path / "s")["media_box"][0]
    sizes = sorted((box["hi"] - box["lo"]).tolist())
    assert_allclose(sizes, [1, 2, 6], rtol=1e-6)
    world = UsdGeom.Xformable(outer).ComputeLocalToWorldTransform(Usd.TimeCode(1))
    ends = np.array([world.Transform((1, 2, 3)), world.Transform((2, 4, 6))])
    assert_allclose(box["lo"], ends.min(axis=0), rtol=1e-6)
    assert_allclose(box["hi"], ends.max(axis=0), rtol=1e-6)


def test_the_cube_s_size_counts(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_box(stage, "/M", 0).CreateSizeAttr(1.0)
    box = export(stage, tmp_path / "s")["media_box"][0]
    assert (box["lo"].tolist(), box["hi"].tolist()) == ([-2.5, -2.5, 2.5], [2.5, 2.5, 7.5])


@pytest.mark.parametrize(
    ("attributes", "wanted"),
    [
        ({"extinction": -0.1}, "/M.nightcity:extinction is -0.1"),
        ({"extinction": float("nan")}, "/M.nightcity:extinction is nan"),
        ({"extinction": float("inf")}, "/M.nightcity:extinction is inf"),
        ({"albedo": 1.5}, "/M.nightcity:albedo is 1.5"),
        ({"albedo": float("nan")}, "/M.nightcity:albedo is nan"),
        ({"reachScale": 0.0}, "/M.nightcity:reachScale is 0.0"),
        ({"mediaId": -1}, "/M.nightcity:mediaId is -1"),
    ],
)
def test_values_out_of_range_are_named(tmp_path: Path, attributes: dict, wanted: str) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_box(stage, "/M", 0, **attributes)
    with pytest.raises(SceneError) as error:
        export(stage, tmp_path / "s")
    assert wanted in str(error.value)


@pytest.mark.parametrize("turn", [45, 0.01])
def test_a_rotated_box_is_an_error(tmp_path: Path, turn: float) -> None:
    stage = new_stage(tmp_path / "a.usda")
    UsdGeom.Xform.Define(stage, "/A").AddRotateZOp().Set(turn)
    add_box(stage, "/A/M", 0)
    with pytest.raises(SceneError, match="/A/M: the media box is rotated or sheared"):
        export(stage, tmp_path / "s")


def test_a_box_without_volume_is_an_error(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_box(stage, "/M", 0, (0, 0, 0), (1, 1, 0))
    with pytest.raises(SceneError, match="/M: the media box has no volume"):
        export(stage, tmp_path / "s")


def test_two_boxes_with_one_number(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_box(stage, "/A", 3)
    add_box(stage, "/B", 3, (5, -5, 0), (15, 5, 10))
    with pytest.raises(SceneError, match="/A and /B: both have nightcity:mediaId 3"):
        export(stage, tmp_path / "s")


def test_overlap_names_both(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    for number in range(20):
        add_box(stage, f"/M{number}", number, (10 * number, 0, 0), (10 * number + 10, 10, 10))
    add_box(stage, "/Odd", 99, (55, 9, 9), (58, 12, 12))
    with pytest.raises(SceneError, match=r"/M5 and /Odd: .* overlap by 3 x 1 x 1 m"):
        export(stage, tmp_path / "s")


@pytest.mark.parametrize("gap", [5e-5, -5e-5])
def test_faces_that_almost_touch_become_equal(tmp_path: Path, gap: float) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_box(stage, "/A", 0, (0, 0, 0), (5, 5, 5))
    add_box(stage, "/B", 1, (5 + gap, 0, 0), (10, 5, 5))
    boxes = export(stage, tmp_path / "s")["media_box"]
    assert boxes["hi"][0, 0] == boxes["lo"][1, 0]
    assert_allclose(boxes["hi"][0, 0], 5, atol=1e-4)


def test_a_box_on_the_ground_starts_there_to_the_bit(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    ground = add_mesh(stage, "/G", [(x, y, 0.1) for x, y, _ in SQUARE[0]], SQUARE[1])
    ground.GetPrim().ApplyAPI("NightcityGroundAPI")
    add_box(stage, "/M", 0, (0, 0, 0.10003), (5, 5, 5))
    scene = export(stage, tmp_path / "s")
    height = scene.manifest["ground"]["height"]
    assert float(scene["media_box"]["lo"][0, 2]) == height == float(np.float32(0.1))


def test_snapping_keeps_the_common_plane_and_does_not_drift() -> None:
    faces = np.array([10, 10, 10, 10.00004])
    lo = np.column_stack([faces, np.arange(4.0), np.arange(4.0)])
    assert (snapped(lo, lo + 1)[0][:, 0] == 10).all()
    chain = np.column_stack([6e-5 * np.arange(100), np.zeros(100), np.zeros(100)])
    moved = np.abs(snapped(chain, chain + 1)[0] - chain)
    assert moved.max() < 1e-4


def windows_and_boxes(tmp_path: Path) -> Usd.Stage:
    """Four windows 10 m apart along x; a box of 10 m about each of the first two."""
    stage = new_stage(tmp_path / "a.usda")
    add_building(stage, "/B", 0)
    add_windows(stage, "/B/W", [(10 * i, 0, 5) for i in range(4)], ids=[40, 30, 20, 10])
    for i in range(2):
        add_box(stage, f"/M{i}", i, (10 * i - 5, -5, 0), (10 * i + 5, 5, 10), windowLights=[])
    return stage


def test_lists_follow_the_geometry(tmp_path: Path) -> None:
    stage = windows_and_boxes(tmp_path)
    stage.GetPrimAtPath("/M1").GetAttribute("nightcity:reachScale").Set(1.9)
    scene = export(stage, tmp_path / "s")
    assert scene.lists() == {0: [40], 1: [40, 30, 20]}  # by ascending index, not id
    assert scene["light_list"]["window"].tolist() == [0, 0, 1, 2]
    assert "of 2 of 2 media boxes no longer fit the geometry" in scene.notes


def test_lists_that_fit_need_no_note(tmp_path: Path) -> None:
    stage = windows_and_boxes(tmp_path)
    for i, ids in enumerate([[40], [30]]):
        stage.GetPrimAtPath(f"/M{i}").GetAttribute("nightcity:windowLights").Set(ids)
    assert "light lists" not in export(stage, tmp_path / "s").notes
    stage.GetPrimAtPath("/M1").RemoveProperty("nightcity:windowLights")
    notes = export(stage, tmp_path / "s").notes
    assert "The light lists of 1 of 2 media boxes are missing and were recomputed: /M1." in notes
    stage.GetPrimAtPath("/M0").GetAttribute("nightcity:windowLights").Set([40, 5])
    notes = export(stage, tmp_path / "s").notes
    assert "of 1 of 2 media boxes no longer fit the geometry and were recomputed: /M0." in notes


def test_hidden_windows_make_no_list_stale(tmp_path: Path) -> None:
    stage = windows_and_boxes(tmp_path)
    for i, ids in enumerate([[40, 77], [30]]):
        stage.GetPrimAtPath(f"/M{i}").GetAttribute("nightcity:windowLights").Set(ids)
    hidden = add_windows(stage, "/Hidden", [(0, 0, 5)], ids=[77])
    UsdGeom.Imageable(hidden).MakeInvisible()
    for lists in ("recomputed", "authored"):
        scene = export(stage, tmp_path / lists, lists=lists)
        assert "light lists" not in scene.notes
        assert scene.lists() == {0: [40], 1: [30]}


def test_single_windows_that_are_hidden_make_no_list_stale(tmp_path: Path) -> None:
    stage = windows_and_boxes(tmp_path)
    for i, ids in enumerate([[40], [30]]):
        stage.GetPrimAtPath(f"/M{i}").GetAttribute("nightcity:windowLights").Set(ids)
    windows = UsdGeom.PointInstancer(stage.GetPrimAtPath("/B/W"))
    windows.CreateInvisibleIdsAttr(Vt.Int64Array([30]))
    for lists in ("recomputed", "authored"):
        scene = export(stage, tmp_path / lists, lists=lists)
        assert "light lists" not in scene.notes
        assert scene.lists() == {0: [40], 1: []}


def test_authored_lists(tmp_path: Path) -> None:
    stage = windows_and_boxes(tmp_path)
    lights = stage.GetPrimAtPath("/M0").GetAttribute("nightcity:windowLights")
    lights.Set([10, 20, 10])
    UsdLux.SphereLight.Define(stage, "/Lamp").AddTranslateOp().Set((0, 0, 5))
    scene = export(stage, tmp_path / "s", lists="authored")
    lamp = int(scene["window"]["window_id"][4])
    assert scene.lists() == {0: [20, 10, lamp], 1: []}  # the stage's own lights by geometry
    lights.Set([10, 5])
    with pytest.raises(SceneError, match=r"/M0.nightcity:windowLights names window 5,"):
        export(stage, tmp_path / "s", lists="authored")


def test_a_stage_s_own_lights_are_listed(tmp_path: Path) -> None:
    stage = windows_and_boxes(tmp_path)
    light = UsdLux.SphereLight.Define(stage, "/Lamp")
    light.CreateRadiusAttr(6)
    light.AddTranslateOp().Set((-10, 0, 5))
    scene = export(stage, tmp_path / "s")
    # Its box reaches from -10 to -10 + 1.3 * 6 = -2.2 m: into the first box only.
    assert scene.lists() == {0: [40, 41], 1: [30]}


def test_animated_haze_is_taken_at_the_first_frame(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    extinction = add_box(stage, "/M", 0).GetPrim().GetAttribute("nightcity:extinction")
    extinction.Set(0.5, 1)
    extinction.Set(1.0, 3)
    scene = export(stage, tmp_path / "s", frames=(2, 3))
    assert scene["media_box"]["extinction"].tolist() == [0.75]
    assert "An animated nightcity:extinction is taken at frame 2: /M." in scene.notes
