# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Windows on the stage: where they are, which way they face, and what shows them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pxr import Usd, UsdGeom, UsdShade
from stage_city import small_city

from nightcity.city.model import Building, City, LightLists, Windows
from nightcity.stage.orientation import orientations
from nightcity.stage.write import write_stage

NOW = Usd.TimeCode.Default()
NO_LISTS = LightLists(np.zeros(1, int), np.empty(0, int))


def written(city: City, folder: Path) -> Usd.Stage:
    return Usd.Stage.Open(str(write_stage(city, folder / "city.usda")[0]))


def instancer(stage: Usd.Stage, building: int = 0) -> UsdGeom.PointInstancer:
    path = f"/City/Buildings/Group_0000/Building_{building}/Windows"
    return UsdGeom.PointInstancer(stage.GetPrimAtPath(path))


def with_windows(city: City, **changes: np.ndarray) -> City:
    first: Building = city.buildings[0]
    windows = replace(first.windows, **changes)
    return replace(city, buildings=(replace(first, windows=windows), *city.buildings[1:]))


def rectangles(stage: Usd.Stage, building: int) -> tuple[np.ndarray, ...]:
    """Centres, half widths and half heights in the world, from USD's own transforms."""
    windows = instancer(stage, building)
    local = windows.ComputeInstanceTransformsAtTime(
        NOW, NOW, windows.IncludeProtoXform, windows.IgnoreMask
    )
    prim = windows.GetPrim()
    world = np.array(local) @ np.array(UsdGeom.XformCache().GetLocalToWorldTransform(prim))
    width, height = prim.GetAttribute("nightcity:windowSize").Get()
    return world[:, 3, :3], world[:, 0, :3] * width / 2, world[:, 1, :3] * height / 2


def check_rectangles(stage: Usd.Stage, building: Building) -> None:
    windows = building.windows
    centres, half_u, half_v = rectangles(stage, building.building_id)
    assert centres == pytest.approx(windows.centres + building.origin, abs=2e-6)
    assert half_u == pytest.approx(windows.half_u, abs=1e-6)
    assert half_v == pytest.approx(windows.half_v, abs=1e-6)


def test_rectangles_come_back(tmp_path: Path) -> None:
    city = small_city()
    stage = written(city, tmp_path)
    for building in city.buildings:
        check_rectangles(stage, building)
    assert not instancer(stage).GetScalesAttr().HasAuthoredValue()


def turned_windows(count: int, seed: int) -> Windows:
    """Panes of any direction, size and roll."""
    rng = np.random.default_rng(seed)
    u, v = rng.normal(size=(2, count, 3))
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    v -= u * (u * v).sum(axis=1, keepdims=True)
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    return Windows(
        centres=rng.uniform(-10, 10, (count, 3)),
        half_u=u * rng.uniform(0.1, 3, (count, 1)),
        half_v=v * rng.uniform(0.1, 3, (count, 1)),
        power=rng.uniform(0, 100, count),
        colours=rng.uniform(0, 1, (count, 3)),
        light_on=rng.random(count) < 0.5,
        ids=1000 + np.arange(count),
    )


def test_panes_of_any_roll_and_size_come_back(tmp_path: Path) -> None:
    city = small_city()
    turned = replace(city.buildings[0], windows=turned_windows(50, seed=3))
    city = replace(small_city(1), buildings=(turned,), media=(), light_lists=NO_LISTS)
    stage = written(city, tmp_path)
    check_rectangles(stage, turned)
    assert len(instancer(stage).GetScalesAttr().Get()) == 50


def test_orientation_of_every_quarter_turn() -> None:
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    frames = [(u, v) for u in axes for v in axes if u @ v == 0]
    assert len(frames) == 24
    u, v = (np.array(each) for each in zip(*frames, strict=True))
    x, y, z, w = orientations(2 * u, 3 * v).T
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    assert rotation[:, 0].T == pytest.approx(u, abs=1e-12)
    assert rotation[:, 1].T == pytest.approx(v, abs=1e-12)
    assert rotation[:, 2].T == pytest.approx(np.cross(u, v), abs=1e-12)
    assert (w >= 0).all()


def emission(stage: Usd.Stage, path: str) -> tuple[float, ...]:
    material = UsdShade.MaterialBindingAPI(stage.GetPrimAtPath(path)).ComputeBoundMaterial()[0]
    return tuple(material.ComputeSurfaceSource()[0].GetInput("emissiveColor").Get())


def test_viewers_see_dark_panes_dark_and_lit_ones_in_their_colour(tmp_path: Path) -> None:
    city = small_city()
    stage = written(city, tmp_path)
    windows = instancer(stage)
    targets = windows.GetPrototypesRel().GetTargets()
    shown = [emission(stage, targets[index]) for index in windows.GetProtoIndicesAttr().Get()]
    expected = np.where(
        city.buildings[0].windows.light_on[:, None], city.buildings[0].windows.colours, 0
    )
    assert shown == pytest.approx(expected, abs=1 / 256)


def test_a_pane_is_the_rectangle_of_window_size(tmp_path: Path) -> None:
    stage = written(small_city(), tmp_path)
    for target in instancer(stage).GetPrototypesRel().GetTargets():
        points = np.array(stage.GetPrimAtPath(target).GetAttribute("points").Get())
        corners = np.array([(-0.6, -0.75, 0), (0.6, -0.75, 0), (0.6, 0.75, 0), (-0.6, 0.75, 0)])
        assert points == pytest.approx(corners, abs=1e-6)


def test_prototypes_are_shared_and_drawn_nowhere_else(tmp_path: Path) -> None:
    stage = written(small_city(), tmp_path)
    first, second = (instancer(stage, number).GetPrototypesRel().GetTargets() for number in (0, 1))
    assert first == second
    assert not any("WindowPrototypes" in str(prim.GetPath()) for prim in stage.Traverse())


def test_many_colours_are_shown_by_few_prototypes(tmp_path: Path) -> None:
    count = 500
    windows = replace(turned_windows(count, seed=5), light_on=np.ones(count, bool))
    building = replace(small_city(1).buildings[0], windows=windows)
    city = replace(small_city(1), buildings=(building,), media=(), light_lists=NO_LISTS)
    stage = written(city, tmp_path)
    targets = instancer(stage).GetPrototypesRel().GetTargets()
    assert 4 < len(targets) <= 17
    shown = np.array([emission(stage, target) for target in targets])
    wanted = windows.colours / windows.colours.max(axis=1, keepdims=True)
    indices = np.array(instancer(stage).GetProtoIndicesAttr().Get())
    assert np.abs(shown[indices] - wanted).max() < 0.51
    colours = np.array(instancer(stage).GetPrim().GetAttribute("nightcity:color").Get())
    assert colours == pytest.approx(windows.colours, abs=1e-6)  # the truth is not rounded


def test_one_value_stands_for_all_where_all_are_equal(tmp_path: Path) -> None:
    stage = written(small_city(), tmp_path)
    prim = instancer(stage).GetPrim()
    assert list(prim.GetAttribute("nightcity:power").Get()) == [50.0]
    assert len(prim.GetAttribute("nightcity:color").Get()) == 4
    assert list(prim.GetAttribute("nightcity:lightOn").Get()) == [True, False, True, True]
    assert list(prim.GetAttribute("ids").Get()) == [0, 1, 2, 3]
    primvars = [each for each in prim.GetAuthoredAttributes() if "primvars:" in each.GetName()]
    assert primvars == []


def test_a_building_without_windows_has_no_instancer(tmp_path: Path) -> None:
    city = small_city()
    empty = {
        name: getattr(city.buildings[0].windows, name)[:0]
        for name in ("centres", "half_u", "half_v", "power", "colours", "light_on", "ids")
    }
    stage = written(replace(with_windows(city, **empty), media=(), light_lists=NO_LISTS), tmp_path)
    assert not instancer(stage, 0).GetPrim()
    assert instancer(stage, 1).GetPrim()


def test_extent_holds_the_rectangles(tmp_path: Path) -> None:
    stage = written(small_city(), tmp_path)
    windows = instancer(stage)
    computed = UsdGeom.PointInstancer.ComputeExtentAtTime(windows, NOW, NOW)
    assert np.array(windows.GetExtentAttr().Get()) == pytest.approx(np.array(computed), abs=1e-5)
