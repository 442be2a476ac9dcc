# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Windows: where they stand, what they send, when they shine, and which of them exist."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from export_maker import Scene, add_building, add_windows, export, new_stage
from numpy.testing import assert_allclose
from pxr import Gf, UsdGeom, Vt

from nightcity.errors import SceneError

ROW = [(0, 0, 1), (3, 0, 1), (6, 0, 1)]


def outward(scene: Scene) -> np.ndarray:
    normal = np.cross(scene["window"]["half_u"], scene["window"]["half_v"])
    return normal / np.linalg.norm(normal, axis=1, keepdims=True)


def test_every_field_of_a_window(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_building(stage, "/B", 7)
    add_windows(stage, "/B/Windows", ROW, ids=[10, 20, 30], **{
        "nightcity:power": [1, 2, 3],
        "nightcity:color": [(1, 1, 1), (1, 0.5, 0.25), (0, 0, 1)],
        "nightcity:lightOn": [True, False, True],
    })  # fmt: skip
    windows = export(stage, tmp_path / "s")["window"]
    assert_allclose(windows["centre"], ROW)
    assert_allclose(windows["half_u"], [(1, 0, 0)] * 3)
    assert_allclose(windows["half_v"], [(0, 0.5, 0)] * 3)
    assert windows["power"].tolist() == [1, 2, 3]
    assert windows["colour"].tolist() == [[1, 1, 1], [1, 0.5, 0.25], [0, 0, 1]]
    assert windows["flags"].tolist() == [1, 0, 1]
    assert windows["window_id"].tolist() == [10, 20, 30]
    assert windows["building"].tolist() == [0, 0, 0]


@pytest.mark.parametrize("name", ["orientations", "orientationsf"])
def test_orientation_and_scale(tmp_path: Path, name: str) -> None:
    """A quarter turn about x brings +z to -y and +y to +z."""
    half = math.sqrt(0.5)
    turn = Gf.Quatf(half, half, 0, 0) if name[-1] == "f" else Gf.Quath(half, half, 0, 0)
    stage = new_stage(tmp_path / "a.usda")
    add_windows(stage, "/W", [(1, 2, 3)], scales=[(2, 3, 1)], **{name: [turn]})
    scene = export(stage, tmp_path / "s")
    tolerance = 1e-3 if name == "orientations" else 1e-6  # half or single precision
    assert_allclose(scene["window"]["half_u"], [(2, 0, 0)], atol=tolerance)
    assert_allclose(scene["window"]["half_v"], [(0, 0, 1.5)], atol=tolerance)
    assert_allclose(outward(scene), [(0, -1, 0)], atol=tolerance)


def test_transform_of_the_prototype_and_of_ancestors(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    UsdGeom.Xform.Define(stage, "/A").AddTranslateOp().Set((100, 0, 0))
    UsdGeom.Xform.Define(stage, "/A/B").AddRotateZOp().Set(90)
    add_windows(stage, "/A/B/W", [(1, 0, 0)])
    pane = UsdGeom.Xformable(stage.GetPrimAtPath("/A/B/W/Pane"))
    pane.AddTranslateOp().Set((0, 0, 5))
    pane.AddScaleOp().Set((2, 1, 1))
    scene = export(stage, tmp_path / "s")
    assert_allclose(scene["window"]["centre"], [(100, 1, 5)], atol=1e-5)
    assert_allclose(scene["window"]["half_u"], [(0, 2, 0)], atol=1e-6)


def test_a_mirrored_transform_keeps_the_lit_side(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    for axis, scale in enumerate([(-1, 1, 1), (1, -1, 1), (1, 1, -1)]):
        UsdGeom.Xform.Define(stage, f"/M{axis}").AddScaleOp().Set(scale)
        add_windows(stage, f"/M{axis}/W", [(0, 0, 1)], ids=[axis])
    scene = export(stage, tmp_path / "s")
    assert_allclose(outward(scene), [(0, 0, 1), (0, 0, 1), (0, 0, -1)])
    assert scene["window"]["centre"][2].tolist() == [0, 0, -1]


def test_invisible_and_inactive_instances_do_not_exist(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    instancer = add_windows(stage, "/W", ROW, ids=[5, 6, 7], **{"nightcity:power": [1, 2, 3]})
    instancer.CreateInvisibleIdsAttr(Vt.Int64Array([6]))
    instancer.DeactivateId(7)
    windows = export(stage, tmp_path / "s")["window"]
    assert windows["window_id"].tolist() == [5]
    assert windows["power"].tolist() == [1]


@pytest.mark.parametrize("how", ["invisible", "inactive", "proxy", "guide"])
def test_what_is_not_rendered_is_left_out(tmp_path: Path, how: str) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_building(stage, "/B", 0)
    add_building(stage, "/C", 1)
    add_windows(stage, "/B/W", ROW)
    add_windows(stage, "/C/W", ROW, ids=[3, 4, 5])
    parent = UsdGeom.Imageable(stage.GetPrimAtPath("/B"))
    if how == "invisible":
        parent.MakeInvisible()
    elif how == "inactive":
        parent.GetPrim().SetActive(False)
    else:
        parent.CreatePurposeAttr(how)
    assert export(stage, tmp_path / "s")["window"]["window_id"].tolist() == [3, 4, 5]


def test_the_night_is_a_first_state_and_changes_only(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    stage.SetStartTimeCode(1)
    stage.SetEndTimeCode(10)
    lit = add_windows(stage, "/W", ROW).GetPrim().GetAttribute("nightcity:lightOn")
    lit.Set([False] * 3, -5)
    lit.Set([True, False, True], 0)  # holds until frame 3
    lit.Set([True, True, True], 3)
    lit.Set([True, True, True], 4)  # no change
    lit.Set([False, True, False], 6.5)
    lit.Set([True] * 3, 11)  # past the last frame
    scene = export(stage, tmp_path / "s")
    assert scene["window"]["flags"].tolist() == [1, 0, 1]
    assert scene["window_event"].tolist() == [(3, 1, 1), (6.5, 0, 0), (6.5, 2, 0)]
    later = export(stage, tmp_path / "t", frames=(5, 6))
    assert later["window"]["flags"].tolist() == [1, 1, 1]
    assert len(later["window_event"]) == 0
    assert later.manifest["frames"] == {"first": 5, "last": 6, "per_second": 24.0}


def test_one_sample_for_all_windows_may_change_too(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    lit = add_windows(stage, "/W", ROW).GetPrim().GetAttribute("nightcity:lightOn")
    lit.Set([False], 1)
    lit.Set([], 2)
    scene = export(stage, tmp_path / "s", frames=(1, 3))
    assert scene["window"]["flags"].tolist() == [0, 0, 0]
    assert scene["window_event"].tolist() == [(2, 0, 1), (2, 1, 1), (2, 2, 1)]


def test_animated_visibility_becomes_events(tmp_path: Path) -> None:
    """A window shines where it is lit, visible, and above it nothing is hidden."""
    stage = new_stage(tmp_path / "a.usda")
    parent = UsdGeom.Xform.Define(stage, "/B").GetVisibilityAttr()
    parent.Set("invisible", 1)
    parent.Set("inherited", 3)
    instancer = add_windows(stage, "/B/W", ROW[:2], **{"nightcity:lightOn": [True, False]})
    own = instancer.GetVisibilityAttr()
    own.Set("inherited", 1)
    own.Set("invisible", 5)
    scene = export(stage, tmp_path / "s", frames=(1, 8))
    assert scene["window"]["flags"].tolist() == [0, 0]
    assert scene["window_event"].tolist() == [(3, 0, 1), (5, 0, 0)]
    assert len(export(stage, tmp_path / "t", frames=(3, 4))["window_event"]) == 0


def test_animated_invisible_ids_become_events(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    hidden = add_windows(stage, "/W", ROW).CreateInvisibleIdsAttr()
    hidden.Set(Vt.Int64Array([0, 2]), 1)
    hidden.Set(Vt.Int64Array([1, 2]), 4)
    scene = export(stage, tmp_path / "s", frames=(1, 8))
    assert scene["window"]["window_id"].tolist() == [0, 1]  # 2 is never there
    assert scene["window"]["flags"].tolist() == [0, 1]
    assert scene["window_event"].tolist() == [(4, 0, 1), (4, 1, 0)]


def test_two_samples_within_one_float_keep_the_last(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    lit = add_windows(stage, "/W", ROW[:1]).GetPrim().GetAttribute("nightcity:lightOn")
    lit.Set([False], 1)
    lit.Set([True], 2)
    lit.Set([False], 2 + 1e-9)
    events = export(stage, tmp_path / "s", frames=(1, 8))["window_event"]
    assert events.tolist() == [(2, 0, 0)]


def test_windows_of_a_building_are_contiguous_and_those_of_none_last(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_windows(stage, "/Loose", ROW[:1], ids=[100])
    add_building(stage, "/B", 0)
    add_windows(stage, "/B/W1", ROW[:2], ids=[0, 1])
    add_building(stage, "/B/Tower", 5)
    add_windows(stage, "/B/Tower/W", ROW[:2], ids=[2, 3])
    add_windows(stage, "/B/Z", ROW[:1], ids=[4])
    scene = export(stage, tmp_path / "s")
    assert scene["window"]["window_id"].tolist() == [0, 1, 4, 2, 3, 100]
    assert scene["window"]["building"].tolist() == [0, 0, 0, 1, 1, 0xFFFFFFFF]
    assert scene["building"].tolist() == [(0, 0, 0, 3, 0), (0, 0, 3, 2, 5)]


@pytest.mark.parametrize(
    ("ids", "fresh"),
    [(None, [0, 1, 2]), ([4, 4, 9], [4, 10, 9]), ([-1, 2**32, 8], [9, 10, 8]),
     ([2**32 - 2, 2**32 - 2, 1], [2**32 - 2, 0, 1])],
)  # fmt: skip
def test_ids_that_cannot_stay_are_replaced(
    tmp_path: Path, ids: list[int] | None, fresh: list[int]
) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_windows(stage, "/W", ROW, ids=ids)
    scene = export(stage, tmp_path / "s")
    assert scene["window"]["window_id"].tolist() == fresh
    assert "have got new ids: /W." in scene.notes


def test_twins_of_a_building_get_ids_of_their_own(tmp_path: Path) -> None:
    """An artist duplicates a building: both keep their windows."""
    stage = new_stage(tmp_path / "a.usda")
    for number in range(2):
        add_building(stage, f"/B{number}", number)
        add_windows(stage, f"/B{number}/W", ROW)
    scene = export(stage, tmp_path / "s")
    assert scene["window"]["window_id"].tolist() == [0, 1, 2, 3, 4, 5]
    assert "have got new ids: /B1/W." in scene.notes


NAN = float("nan")


@pytest.mark.parametrize(
    ("attributes", "wanted"),
    [
        ({"nightcity:power": [1, 2]}, "/W.nightcity:power has 2 values"),
        ({"nightcity:power": []}, "/W.nightcity:power has 0 values"),
        ({"nightcity:color": [(1, 1, 1)] * 4}, "/W.nightcity:color has 4 values"),
        ({"nightcity:lightOn": [True, False]}, "/W.nightcity:lightOn has 2 values"),
        ({"nightcity:power": [1, -1, 1]}, "/W (instance 1): its power"),
        ({"nightcity:power": [1, 1, NAN]}, "/W (instance 2): its power"),
        ({"nightcity:power": [3e38], "nightcity:color": [(9, 1, 1)]}, "power times its color"),
        ({"nightcity:color": [(1, NAN, 1)]}, "/W (instance 0): its power and colour"),
        ({"nightcity:windowSize": (0, 1)}, "/W.nightcity:windowSize"),
        ({"nightcity:windowSize": (1, NAN)}, "/W.nightcity:windowSize"),
        ({"positions": [(0, 0, NAN)] * 3}, "its position or size is not finite"),
        ({"positions": ROW[:2]}, "/W.positions has 2 values, but protoIndices has 3"),
        ({"scales": [(1, 1, 1)]}, "/W.scales has 1 values"),
        ({"scales": [(1, 1, 1), (0, 1, 1), (1, 1, 1)]}, "/W (instance 1): it has no width"),
        ({"orientationsf": [Gf.Quatf(1)]}, "/W.orientationsf has 1 values"),
        ({"ids": [1]}, "/W.ids has 1 values"),
        ({"protoIndices": [0, 0, 3]}, "/W: its 1 prototypes do not fit"),
        ({"protoIndices": [0, 0, -1]}, "/W: its 1 prototypes do not fit"),
    ],
)
def test_bad_windows_are_named(tmp_path: Path, attributes: dict[str, object], wanted: str) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_windows(stage, "/W", ROW, **attributes)
    with pytest.raises(SceneError) as error:
        export(stage, tmp_path / "s")
    assert wanted in str(error.value)
    assert not (tmp_path / "s").exists()


@pytest.mark.parametrize(("shear", "refused"), [(0.0005, False), (0.01, True)])
def test_sheared_panes(tmp_path: Path, shear: float, refused: bool) -> None:
    stage = new_stage(tmp_path / "a.usda")
    matrix = Gf.Matrix4d(1)
    matrix[1, 0] = shear
    UsdGeom.Xform.Define(stage, "/B").AddTransformOp().Set(matrix)
    add_windows(stage, "/B/W", ROW)
    if refused:
        with pytest.raises(SceneError, match=r"/B/W \(instance 0\): its transform shears it"):
            export(stage, tmp_path / "s")
    else:
        assert len(export(stage, tmp_path / "s")["window"]) == 3


def test_an_instancer_without_windows(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_windows(stage, "/Empty", [])
    add_windows(stage, "/W", ROW)
    assert len(export(stage, tmp_path / "s")["window"]) == 3


def test_moving_windows_are_taken_at_the_first_frame(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    move = UsdGeom.Xform.Define(stage, "/B").AddTranslateOp()
    move.Set((0, 0, 0), 1)
    move.Set((9, 0, 0), 10)
    add_windows(stage, "/B/W", ROW)
    scene = export(stage, tmp_path / "s", frames=(4, 5))
    assert_allclose(scene["window"]["centre"][0], (3, 0, 1))
    assert "What moves over time is taken where it is at frame 4: /B." in scene.notes
