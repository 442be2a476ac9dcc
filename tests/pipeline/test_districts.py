# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A large city: districts as payloads, written and read one at a time, hold the same city."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from export_maker import Scene
from pxr import Sdf, Usd, UsdGeom, Vt

from nightcity.city import districts as cutting
from nightcity.city.generate import generate
from nightcity.city.model import City
from nightcity.city.parameters import load_parameters
from nightcity.errors import SceneError
from nightcity.export.export_stage import export_stage
from nightcity.stage.validate import validate_stage
from nightcity.stage.write import write_stage


@pytest.fixture(scope="module")
def city() -> City:
    return generate(load_parameters("mixed-6x6", {"facade_textures": ["brick", "plain"]}))


@pytest.fixture(scope="module")
def folder(city: City, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same city whole, as whole.usda, and in districts, as cut.usda; each exported."""
    folder = tmp_path_factory.mktemp("districts")
    write_stage(city, folder / "whole.usda")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cutting, "WHOLE", 20)
        patch.setattr(cutting, "_BUILDINGS", 6)
        write_stage(city, folder / "cut.usda")
    for name in ("whole", "cut"):
        export_stage(folder / f"{name}.usda", folder / name)
    return folder


def test_districts_hold_every_building_and_box_once(city: City) -> None:
    parts = cutting.districts(city)
    for which, count in ((0, len(city.buildings)), (1, len(city.media))):
        held = np.concatenate([part[which] for part in parts])
        assert sorted(held.tolist()) == list(range(count))
    cut = list(cutting.district_cities(city, parts))
    listed = sum(len(each.light_lists.window_ids) for each in cut)
    assert listed == len(city.light_lists.window_ids)


def test_districts_in_a_line_are_no_sliver(city: City, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cutting, "_BUILDINGS", 2)
    row = [b for b in city.buildings if b.origin[1] == city.buildings[0].origin[1]]
    line = type(city)(**{**vars(city), "buildings": tuple(row)})
    assert len([part for part in cutting.districts(line) if len(part[0])]) == 3


def test_the_stage_has_payloads_that_open_alone(folder: Path) -> None:
    stage = Usd.Stage.Open(str(folder / "cut.usda"), Usd.Stage.LoadNone)
    names = [prim.GetName() for prim in stage.GetPrimAtPath("/City/Districts").GetAllChildren()]
    assert len(names) > 3 and names == sorted(names)
    assert not any(len(prim.GetAllChildren()) for prim in stage.GetPrimAtPath(
        "/City/Districts").GetAllChildren())  # fmt: skip
    alone = Usd.Stage.Open(str(folder / "cut.districts" / f"{names[0]}.usda"))
    assert alone.GetPrimAtPath("/City/Buildings/Group_0000").GetAllChildren()
    assert not alone.GetCompositionErrors()


def test_districts_are_valid(folder: Path) -> None:
    assert [str(finding) for finding in validate_stage(folder / "cut.usda")] == []


def faulty(folder: Path) -> Path:
    """The city in districts, under a layer with faults inside, across and outside of them."""
    layer = Sdf.Layer.CreateNew(str(folder / "faulty.usda"))
    layer.subLayerPaths.append(str(folder / "cut.usda"))
    stage = Usd.Stage.Open(layer)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.z)
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    one, other = (f"/City/Districts/District_000{number}" for number in (1, 3))
    boxes = [f"{district}/Media/Group_0000" for district in (one, other)]
    first, second = (stage.GetPrimAtPath(path).GetChildren()[0] for path in boxes)
    first.GetAttribute("nightcity:extinction").Set(-1.0)
    first.GetAttribute("nightcity:windowLights").Set(Vt.IntArray([3, 99999]))
    second.GetAttribute("nightcity:mediaId").Set(first.GetAttribute("nightcity:mediaId").Get())
    second.GetAttribute("xformOp:translate").Set(first.GetAttribute("xformOp:translate").Get())
    buildings = [
        stage.GetPrimAtPath(f"{district}/Buildings/Group_0000").GetChildren()[0]
        for district in (one, other)
    ]
    windows = [building.GetChild("Windows") for building in buildings]
    sources = first.GetRelationship("nightcity:windowLightSources")
    sources.SetTargets([windows[1].GetPath()])
    second.GetRelationship("nightcity:windowLightSources").SetTargets(["/City/Nothing"])
    windows[1].GetAttribute("ids").Set(windows[0].GetAttribute("ids").Get())
    number = "nightcity:buildingId"
    buildings[1].GetAttribute(number).Set(buildings[0].GetAttribute(number).Get())
    spec = Sdf.CreatePrimInLayer(layer, windows[0].GetPath())
    Sdf.AttributeSpec(spec, "nightcity:windowSize", Sdf.ValueTypeNames.String)
    buildings[0].GetReferences().AddReference("./gone.usda")
    stage.DefinePrim("/City/Ground2", "Mesh").ApplyAPI("NightcityGroundAPI")
    stage.GetPrimAtPath("/City/Cameras").SetActive(False)
    Sdf.CreatePrimInLayer(layer, other).SetInfo(
        "apiSchemas", Sdf.TokenListOp.Create(prependedItems=["NightcityMediumAPI"])
    )
    layer.Save()
    return folder / "faulty.usda"


def test_districts_have_the_findings_of_the_whole(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = faulty(folder)
    streamed = validate_stage(path)
    monkeypatch.setattr(
        "nightcity.stage.validate.open_outside",
        lambda path: (Usd.Stage.Open(str(path), Usd.Stage.LoadAll), ()),
    )
    assert [str(each) for each in streamed] == [str(each) for each in validate_stage(path)]
    found = {each.attribute for each in streamed}
    assert found >= {
        "nightcity:extinction", "nightcity:windowLights", "nightcity:mediaId", "ids",
        "nightcity:windowLightSources", "nightcity:buildingId", "nightcity:windowSize",
        "xformOpOrder", "points", "apiSchemas", "",
    }  # fmt: skip
    assert any("gone.usda" in each.message for each in streamed)


def test_the_same_city_comes_out(folder: Path) -> None:
    whole, cut = Scene(folder / "whole"), Scene(folder / "cut")
    assert not cut.notes and not whole.notes
    by_id = {}
    for name, scene in (("whole", whole), ("cut", cut)):
        windows, boxes = np.array(scene["window"]), np.array(scene["media_box"])
        lights = windows["window_id"][scene["light_list"]["window"]]
        lists = {
            int(box["media_id"]): sorted(
                lights[box["first_light"] : box["first_light"] + box["light_count"]].tolist()
            )
            for box in boxes
        }
        owner = scene["building"]["building_id"][windows["building"]]
        order = np.argsort(windows["window_id"])
        windows["building"] = owner
        boxes[["first_light", "light_count"]] = 0
        by_id[name] = windows[order], np.sort(boxes, order="media_id"), lists
    assert (by_id["whole"][0] == by_id["cut"][0]).all()
    assert (by_id["whole"][1] == by_id["cut"][1]).all()
    assert by_id["whole"][2] == by_id["cut"][2]
    assert surfaces(whole) == surfaces(cut)
    for key in ("cameras", "ground", "origin", "render", "frames"):
        assert whole.manifest[key] == cut.manifest[key] or key == "ground"
    assert whole.manifest["ground"]["height"] == cut.manifest["ground"]["height"]


def surfaces(scene: Scene) -> list[tuple]:
    """Every triangle with its corners, texture coordinates and what its material looks like."""
    position, texcoord = scene["position"]["position"], scene["texcoord"]["texcoord"]
    looks = [
        (*material["reflectance"].tolist(), int(material["width"]), int(material["height"]))
        for material in scene["material"]
    ]
    return sorted(
        (
            *position[triangle["vertex"]].ravel().tolist(),
            *texcoord[triangle["vertex"]].ravel().tolist(),
            looks[triangle["material"]],
        )
        for triangle in scene["triangle"]
    )


def test_the_same_bytes_again(folder: Path, tmp_path: Path) -> None:
    export_stage(folder / "cut.usda", tmp_path / "again")
    for name in ("scene.json", "scene.bin"):
        assert (tmp_path / "again" / name).read_bytes() == (folder / "cut" / name).read_bytes()


def test_a_building_moved_above_the_districts(folder: Path, tmp_path: Path) -> None:
    """What an artist's layer says of a prim inside a district counts."""
    layer = Sdf.Layer.CreateNew(str(tmp_path / "moved.usda"))
    layer.subLayerPaths.append(str(folder / "cut.usda"))
    stage = Usd.Stage.Open(layer)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.z)
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    prim = stage.GetPrimAtPath("/City/Districts/District_0001/Buildings/Group_0000")
    prim.GetChildren()[0].SetActive(False)
    stage.GetPrimAtPath("/City/Districts/District_0000").SetActive(False)
    layer.Save()
    export_stage(tmp_path / "moved.usda", tmp_path / "scene")
    gone = len(Scene(folder / "cut")["building"]) - len(Scene(tmp_path / "scene")["building"])
    first = Usd.Stage.Open(str(folder / "cut.districts" / "District_0000.usda"))
    inside = first.GetPrimAtPath("/City/Buildings/Group_0000").GetAllChildren()
    assert gone == len(inside) + 1


def test_a_district_whose_file_is_gone_is_named(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder, tmp_path / "copy")
    (tmp_path / "copy" / "cut.districts" / "District_0002.windows.usdc").unlink()
    with pytest.raises(SceneError, match=r"District_0002\.windows\.usdc"):
        export_stage(tmp_path / "copy" / "cut.usda", tmp_path / "scene")
    assert not (tmp_path / "scene").exists()
    found = [str(each) for each in validate_stage(tmp_path / "copy" / "cut.usda")]
    assert any(each.startswith("error") and "District_0002.windows.usdc" in each for each in found)


def test_a_truncated_layer_of_a_district_is_found(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder, tmp_path / "copy")
    layer = tmp_path / "copy" / "cut.districts" / "District_0002.windows.usdc"
    layer.write_bytes(layer.read_bytes()[:1000])
    found = [str(each) for each in validate_stage(tmp_path / "copy" / "cut.usda")]
    assert any(each.startswith("error") and layer.name in each for each in found)
