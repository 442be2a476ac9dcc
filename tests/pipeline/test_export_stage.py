# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A stage as a whole: opening, composing, instancing, units, artists' layers, and writing."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
import xxhash
from export_maker import (
    SQUARE,
    Scene,
    add_box,
    add_building,
    add_mesh,
    add_windows,
    export,
    new_stage,
)
from numpy.testing import assert_allclose
from pxr import Gf, Sdf, Usd, UsdGeom, UsdLux, UsdShade, Vt

from nightcity.errors import NightcityError, SceneError, UsageError
from nightcity.export.export_stage import export_stage
from nightcity.export.records import RECORDS, fields


def small_city(path: Path) -> Usd.Stage:
    """One of everything."""
    stage = new_stage(path)
    add_building(stage, "/City/B0", 0)
    add_mesh(stage, "/City/B0/Shell", *SQUARE)
    add_windows(stage, "/City/B0/Windows", [(0, 0, 2), (1, 0, 2)])
    add_box(stage, "/City/Media", 0, windowLights=[0, 1])
    UsdGeom.Camera.Define(stage, "/City/Cam").AddTranslateOp().Set((0, 0, 50))
    return stage


# Opening


@pytest.mark.parametrize("text", [None, "no stage at all", "#usda 1.0\ndef {"])
def test_what_is_no_stage(tmp_path: Path, text: str | None) -> None:
    path = tmp_path / "a.usda"
    if text is not None:
        path.write_text(text)
    with pytest.raises(SceneError, match=r"a\.usda"):
        export_stage(path, tmp_path / "s")
    with pytest.raises(SceneError):
        export_stage(tmp_path, tmp_path / "s")
    assert not (tmp_path / "s").exists()


@pytest.mark.parametrize(
    "line",
    ['(subLayers = [@gone.usda@])', 'def "A" (payload = @gone.usda@) {}',
     'def "A" (references = @gone.usda@</X>) {}', 'def "A" (references = </Gone>) {}'],
)  # fmt: skip
def test_what_is_missing_is_named(tmp_path: Path, line: str) -> None:
    path = tmp_path / "a.usda"
    path.write_text(f"#usda 1.0\n{line}\n")
    with pytest.raises(SceneError, match=r"(?i)gone"):
        export_stage(path, tmp_path / "s")


def test_nothing_at_all(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    UsdGeom.Xform.Define(stage, "/A")
    with pytest.raises(SceneError, match="nothing on the stage is visible and renderable"):
        export(stage, tmp_path / "s")
    UsdGeom.Camera.Define(stage, "/C")
    scene = export(stage, tmp_path / "s")
    assert "The scene has no window or light." in scene.notes
    assert "The scene has no media box." in scene.notes
    add_box(stage, "/M", 0)
    stage.RemovePrim("/C")
    assert "The scene has no camera." in export(stage, tmp_path / "s").notes


@pytest.mark.parametrize(
    ("schema", "kind"),
    [("Windows", "Xform"), ("Media", "Mesh"), ("Media", "Sphere"), ("Ground", "Cube")],
)
def test_a_schema_on_the_wrong_prim(tmp_path: Path, schema: str, kind: str) -> None:
    path = tmp_path / "a.usda"
    path.write_text(
        f'#usda 1.0\ndef {kind} "A" (prepend apiSchemas = ["Nightcity{schema}API"]) {{}}\n'
    )
    with pytest.raises(SceneError, match=f"/A: Nightcity{schema}API belongs on a .* '{kind}'"):
        export_stage(path, tmp_path / "s")


def test_wrong_arguments(tmp_path: Path) -> None:
    small_city(tmp_path / "a.usda").Save()
    with pytest.raises(UsageError, match="lists must be one of recomputed, authored"):
        export_stage(tmp_path / "a.usda", tmp_path / "s", lists="new")
    with pytest.raises(UsageError, match="frames 3-2 end before they begin"):
        export_stage(tmp_path / "a.usda", tmp_path / "s", frames=(3, 2))


# Units, up axis, origin, frames


def test_units_and_up_axis(tmp_path: Path) -> None:
    """Centimetres and Y up: (x, y, z) becomes (x, -z, y) / 100."""
    stage = new_stage(tmp_path / "a.usda", up="Y", unit=0.01)
    add_building(stage, "/B", 0).AddTranslateOp().Set((100, 200, 300))
    add_mesh(stage, "/B/M", *SQUARE)
    add_windows(stage, "/B/W", [(0, 0, 0)])
    add_box(stage, "/Box", 0, (0, 0, 0), (100, 200, 300))
    scene = export(stage, tmp_path / "s")
    assert_allclose(scene["window"]["centre"], [(1, -3, 2)])
    assert_allclose(scene["window"]["half_u"], [(0.01, 0, 0)])
    assert_allclose(scene["window"]["half_v"], [(0, 0, 0.005)], atol=1e-9)
    assert_allclose(scene["media_box"]["lo"], [(0, -3, 0)])
    assert_allclose(scene["media_box"]["hi"], [(1, 0, 2)])
    assert scene["media_box"]["extinction"][0] == np.float32(0.01)  # per metre, in every unit
    assert_allclose(scene["position"]["position"][2], (1.01, -3, 2.01), rtol=1e-6)


def test_a_reset_transform_stack_still_has_units(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda", unit=0.01)
    UsdGeom.Xform.Define(stage, "/A").AddTranslateOp().Set((5000, 0, 0))
    cube = UsdGeom.Cube.Define(stage, "/A/C")
    cube.AddTranslateOp().Set((100, 0, 0))
    cube.SetResetXformStack(True)
    scene = export(stage, tmp_path / "s")
    assert_allclose(scene["position"]["position"].mean(axis=0), (1, 0, 0), atol=1e-6)


def test_a_stage_without_units_says_so(tmp_path: Path) -> None:
    path = tmp_path / "a.usda"
    path.write_text('#usda 1.0\ndef Cube "A" { \ndouble size = 100\n}\n')
    export_stage(path, tmp_path / "s")
    scene = Scene(tmp_path / "s")
    assert_allclose(np.ptp(scene["position"]["position"], axis=0), (1, 1, 1))
    assert "The stage states no metersPerUnit, which in USD means centimetres." in scene.notes
    assert "The stage states no upAxis, which in USD means Y up." in scene.notes


@pytest.mark.parametrize(
    ("place", "origin"),
    [((0, 0, 0), [0, 0, 0]), ((500, -500, 0), [0, 0, 0]), ((600, -600, 0), [1024, -1024, 0]),
     ((1e6, 3e5, 40), [977 * 1024, 293 * 1024, 0])],
)  # fmt: skip
def test_the_origin(tmp_path: Path, place: tuple, origin: list[float]) -> None:
    stage = new_stage(tmp_path / "a.usda")
    matrix = Gf.Matrix4d(1).SetTranslate(Gf.Vec3d(*place))
    UsdGeom.Xform.Define(stage, "/A").AddTransformOp().Set(matrix)
    add_building(stage, "/A/B", 0)
    add_mesh(stage, "/A/B/M", *SQUARE)
    add_windows(stage, "/A/B/W", [(0.015625, 0, 2)])
    add_box(stage, "/A/Box", 0, (0, 0, 0), (0.5, 1, 4))
    ground = add_mesh(stage, "/A/G", *SQUARE).GetPrim()
    ground.ApplyAPI("NightcityGroundAPI")
    camera = UsdGeom.Camera.Define(stage, "/A/Cam")
    camera.AddTranslateOp().Set((0, 0, 8))
    scene = export(stage, tmp_path / "s")
    assert scene.manifest["origin"] == origin
    shift = np.array(place) - origin
    assert np.abs(shift[:2]).max() <= 512
    assert scene["window"]["centre"][0].tolist() == (shift + (0.015625, 0, 2)).tolist()
    assert scene["media_box"]["hi"][0].tolist() == (shift + (0.5, 1, 4)).tolist()
    assert scene["position"]["position"][2].tolist() == (shift + (1, 1, 0)).tolist()
    assert scene["camera_frame"]["position"][0].tolist() == (shift + (0, 0, 8)).tolist()
    assert scene.manifest["ground"]["height"] == shift[2]


def test_frames(tmp_path: Path) -> None:
    stage = small_city(tmp_path / "a.usda")
    frames = export(stage, tmp_path / "s").manifest["frames"]
    assert frames == {"first": 1, "last": 1, "per_second": 24.0}
    stage.SetStartTimeCode(101)
    stage.SetEndTimeCode(148.5)
    stage.SetTimeCodesPerSecond(30)
    frames = export(stage, tmp_path / "s").manifest["frames"]
    assert frames == {"first": 101, "last": 148, "per_second": 30.0}
    frames = export(stage, tmp_path / "s", frames=(7, 9)).manifest["frames"]
    assert (frames["first"], frames["last"]) == (7, 9)


def test_animation_without_frames_is_said(tmp_path: Path) -> None:
    stage = small_city(tmp_path / "a.usda")
    lit = stage.GetPrimAtPath("/City/B0/Windows").GetAttribute("nightcity:lightOn")
    assert "animated" not in export(stage, tmp_path / "s").notes
    lit.Set([True], 1)
    lit.Set([False], 5)
    assert (
        "The stage is animated but states no startTimeCode" in export(stage, tmp_path / "s").notes
    )


# Composition and instancing


def test_variants_and_inactive_prims(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    prim = UsdGeom.Xform.Define(stage, "/A").GetPrim()
    variants = prim.GetVariantSets().AddVariantSet("size")
    for name, edge in (("small", 2), ("large", 6)):
        variants.AddVariant(name)
        variants.SetVariantSelection(name)
        with variants.GetVariantEditContext():
            UsdGeom.Cube.Define(stage, "/A/C").CreateSizeAttr(edge)
    UsdGeom.Cube.Define(stage, "/Off").GetPrim().SetActive(False)
    scene = export(stage, tmp_path / "s")
    assert_allclose(np.ptp(scene["position"]["position"], axis=0), (6, 6, 6))


def building_layer(path: Path) -> None:
    """A building with everything, as a file to refer to."""
    stage = new_stage(path)
    add_building(stage, "/Block", 4)
    stage.SetDefaultPrim(stage.GetPrimAtPath("/Block"))
    shell = UsdGeom.Cube.Define(stage, "/Block/Shell")
    shell.CreateSizeAttr(4.0)
    paint = UsdShade.Material.Define(stage, "/Block/Looks/Paint")
    shader = UsdShade.Shader.Define(stage, "/Block/Looks/Paint/Surface")
    shader.CreateIdAttr("UsdPreviewSurface")
    shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set((0.25, 0.5, 1))
    paint.CreateSurfaceOutput().ConnectToSource(shader.ConnectableAPI(), "surface")
    UsdShade.MaterialBindingAPI.Apply(shell.GetPrim()).Bind(paint)
    add_windows(stage, "/Block/Windows", [(2.01, 0, 3), (-2.01, 0, 3)], ids=[8, 9])
    add_box(stage, "/Block/Haze", 6, (-5, -5, 2), (5, 5, 4), windowLights=[8, 9])
    stage.Save()


@pytest.mark.parametrize("how", ["references", "payload", "instance"])
def test_references_payloads_and_native_instances(tmp_path: Path, how: str) -> None:
    building_layer(tmp_path / "block.usda")
    stage = new_stage(tmp_path / "a.usda")
    for number in range(2):
        xform = UsdGeom.Xform.Define(stage, f"/B{number}")
        arcs = xform.GetPrim().GetPayloads() if how == "payload" else xform.GetPrim()
        (arcs.AddPayload if how == "payload" else arcs.GetReferences().AddReference)("block.usda")
        xform.AddTranslateOp().Set((30 * number, 0, 0))
        if how == "instance":
            xform.GetPrim().SetInstanceable(True)
        elif number:
            stage.GetPrimAtPath(f"/B{number}/Haze").GetAttribute("nightcity:mediaId").Set(7)
    scene = export(stage, tmp_path / "s")
    assert scene["building"]["triangle_count"].tolist() == [12, 12]
    assert scene["building"]["window_count"].tolist() == [2, 2]
    assert_allclose(scene["window"]["centre"][:, 0], [2.01, -2.01, 32.01, 27.99])
    assert scene["window"]["window_id"].tolist() == [8, 9, 10, 11]
    assert scene["media_box"]["media_id"].tolist() == [6, 7]
    assert scene.lists() == {6: [8, 9], 7: [10, 11]}
    assert scene["material"]["reflectance"].tolist() == [[0.25, 0.5, 1]]


def test_two_windows_files_with_one_media_id(tmp_path: Path) -> None:
    building_layer(tmp_path / "block.usda")
    stage = new_stage(tmp_path / "a.usda")
    for number in range(2):
        xform = UsdGeom.Xform.Define(stage, f"/B{number}")
        xform.GetPrim().GetReferences().AddReference("block.usda")
        xform.AddTranslateOp().Set((30 * number, 0, 0))
    with pytest.raises(SceneError, match="/B0/Haze and /B1/Haze: both have nightcity:mediaId 6"):
        export(stage, tmp_path / "s")


@pytest.mark.parametrize("holder", [Sdf.SpecifierClass, Sdf.SpecifierOver])
def test_an_instancer_of_buildings(tmp_path: Path, holder: Sdf.Specifier) -> None:
    """Prototypes that show nowhere else, with buildings, windows, haze and lights; one instance
    is hidden."""
    building_layer(tmp_path / "block.usda")
    stage = new_stage(tmp_path / "a.usda")
    block = UsdGeom.Xform.Define(stage, "/Prototypes/Block")
    block.GetPrim().GetReferences().AddReference("block.usda")
    block.AddTranslateOp().Set((0, 0, 2))  # the prototype's own
    UsdLux.SphereLight.Define(stage, "/Prototypes/Block/Lamp")
    instancer = UsdGeom.PointInstancer.Define(stage, "/District")
    instancer.CreatePrototypesRel().AddTarget("/Prototypes/Block")
    instancer.CreatePositionsAttr([(0, 0, 0), (50, 0, 0), (100, 0, 0)])
    instancer.CreateProtoIndicesAttr([0, 0, 0])
    instancer.CreateIdsAttr([1, 2, 3])
    instancer.CreateInvisibleIdsAttr(Vt.Int64Array([2]))
    instancer.AddTranslateOp().Set((0, 7, 0))
    stage.GetRootLayer().GetPrimAtPath("/Prototypes").specifier = holder
    scene = export(stage, tmp_path / "s")
    assert scene["building"].tolist() == [(0, 12, 0, 2, 4), (12, 12, 2, 2, 4)]
    expected = [(2.01, 7, 5), (-2.01, 7, 5), (102.01, 7, 5), (97.99, 7, 5), (0, 7, 2), (100, 7, 2)]
    assert_allclose(scene["window"]["centre"], expected)
    assert len(set(scene["window"]["window_id"].tolist())) == 6
    assert scene["window"]["window_id"][:2].tolist() == [8, 9]
    assert scene["material"]["reflectance"].tolist() == [[0.25, 0.5, 1]]
    assert scene["media_box"]["media_id"].tolist() == [6, 7]
    assert_allclose(scene["media_box"]["lo"], [(-5, 2, 4), (95, 2, 4)])
    assert_allclose(scene.corners()[12:].mean(axis=(0, 1)), (100, 7, 2), atol=1e-5)
    assert "Instances of a media box have got new mediaIds" in scene.notes
    assert "have got new ids: /Prototypes/Block/Windows." in scene.notes


def test_nested_and_mirrored_instancers(tmp_path: Path) -> None:
    """2 x 3 cubes; those of the building's own instancer belong to it."""
    stage = new_stage(tmp_path / "a.usda")
    add_building(stage, "/B", 0)
    outer = UsdGeom.PointInstancer.Define(stage, "/B/Outer")
    inner = UsdGeom.PointInstancer.Define(stage, "/B/Outer/Inner")
    UsdGeom.Cube.Define(stage, "/B/Outer/Inner/Cube").CreateSizeAttr(1.0)
    inner.CreatePrototypesRel().AddTarget("/B/Outer/Inner/Cube")
    inner.CreatePositionsAttr([(2 * i, 0, 0) for i in range(3)])
    inner.CreateProtoIndicesAttr([0] * 3)
    outer.CreatePrototypesRel().AddTarget("/B/Outer/Inner")
    outer.CreatePositionsAttr([(0, 0, 0), (0, 10, 0)])
    outer.CreateScalesAttr([(1, 1, 1), (-1, 1, 1)])
    outer.CreateProtoIndicesAttr([0, 0])
    scene = export(stage, tmp_path / "s")
    assert scene["building"]["triangle_count"].tolist() == [72]
    centres = scene.corners().reshape(6, 12, 3, 3).mean(axis=(1, 2))
    expected = [(0, 0, 0), (2, 0, 0), (4, 0, 0), (0, 10, 0), (-2, 10, 0), (-4, 10, 0)]
    assert_allclose(sorted(map(tuple, centres.round(6))), sorted(expected), atol=1e-6)
    volumes = np.linalg.det(scene.corners().reshape(6, 12, 3, 3).astype(float)).sum(axis=1) / 6
    assert_allclose(volumes, 1, rtol=1e-5)


def test_a_prototype_that_contains_itself(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    UsdGeom.Xform.Define(stage, "/P")
    instancer = UsdGeom.PointInstancer.Define(stage, "/P/I")
    instancer.CreatePrototypesRel().AddTarget("/P")
    instancer.CreatePositionsAttr([(0, 0, 0)])
    instancer.CreateProtoIndicesAttr([0])
    with pytest.raises(SceneError, match="/P/I: its prototype /P contains itself"):
        export(stage, tmp_path / "s")
    instancer.GetPrototypesRel().SetTargets(["/Nowhere"])
    with pytest.raises(SceneError, match=r"/P/I: .*no prim"):
        export(stage, tmp_path / "s")


def test_moving_buildings_are_named_once(tmp_path: Path) -> None:
    stage = small_city(tmp_path / "a.usda")
    move = UsdGeom.Xformable(stage.GetPrimAtPath("/City/B0")).AddTranslateOp()
    move.Set((0, 0, 0), 1)
    move.Set((9, 0, 0), 10)
    notes = export(stage, tmp_path / "s", frames=(1, 10)).notes
    assert notes.count("What moves") == 1
    assert "What moves over time is taken where it is at frame 1: /City/B0." in notes


def test_an_artist_s_stronger_layer(tmp_path: Path) -> None:
    """A building moved, windows off, the haze changed, a camera added: all arrive."""
    small_city(tmp_path / "city.usda").Save()
    stage = Usd.Stage.CreateNew(str(tmp_path / "shot.usda"))
    stage.GetRootLayer().subLayerPaths = ["city.usda"]
    UsdGeom.SetStageUpAxis(stage, "Z")
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.Xformable(stage.OverridePrim("/City/B0")).AddTranslateOp().Set((100, 0, 0))
    windows = stage.OverridePrim("/City/B0/Windows")
    windows.GetAttribute("nightcity:lightOn").Set([False, True])
    stage.OverridePrim("/City/Media").GetAttribute("nightcity:extinction").Set(0.25)
    UsdGeom.Camera.Define(stage, "/City/Extra")
    scene = export(stage, tmp_path / "s")
    assert_allclose(scene["window"]["centre"][:, 0], [100, 101])
    assert scene["window"]["flags"].tolist() == [0, 1]
    assert scene["media_box"]["extinction"].tolist() == [0.25]
    assert [entry["name"] for entry in scene.manifest["cameras"]] == ["Cam", "Extra"]
    assert scene.lists() == {0: []}
    assert "of 1 of 1 media boxes no longer fit the geometry" in scene.notes


# Writing


def test_the_file_is_as_documented(tmp_path: Path) -> None:
    scene = export(small_city(tmp_path / "a.usda"), tmp_path / "s")
    manifest = scene.manifest
    assert (manifest["format"], manifest["version"]) == ("nightcity-scene", 1)
    assert manifest["byte_order"] == "little" and manifest["up_axis"] == "z"
    assert manifest["binary"] == {
        "file": "scene.bin",
        "bytes": len(scene.bytes),
        "hash": xxhash.xxh3_128_hexdigest(scene.bytes),
    }
    end = 0
    for name in RECORDS:
        entry = manifest["arrays"][name]
        assert entry["offset"] % 64 == 0
        assert not any(scene.bytes[end : entry["offset"]])
        end = entry["offset"] + entry["count"] * entry["stride"]
        assert entry["stride"] == RECORDS[name].itemsize
        assert entry["fields"] == fields(name)
        assert scene.report.counts[name] == entry["count"]
    assert end == len(scene.bytes)
    text = (tmp_path / "s/scene.json").read_text()
    assert str(tmp_path) not in text and text.index('"arrays"') < text.index('"binary"')
    assert scene.report.sizes == {"scene.json": len(text.encode()), "scene.bin": end}
    assert "1 building, 2 window, 1 media_box, 2 triangle, 2 light_list" in str(scene.report)


def test_same_stage_same_bytes(tmp_path: Path) -> None:
    """Also from another folder, and over an earlier scene."""
    for name in ("x", "y"):
        (tmp_path / name).mkdir()
        export(small_city(tmp_path / name / "a.usda"), tmp_path / name / "s")
    export_stage(tmp_path / "y/a.usda", tmp_path / "y/s")
    for file in ("scene.json", "scene.bin"):
        assert (tmp_path / "x/s" / file).read_bytes() == (tmp_path / "y/s" / file).read_bytes()
    assert sorted(path.name for path in (tmp_path / "y/s").iterdir()) == ["scene.bin", "scene.json"]


def test_a_failure_leaves_the_earlier_scene(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stage = small_city(tmp_path / "a.usda")
    export(stage, tmp_path / "s")
    before = {path.name: path.read_bytes() for path in (tmp_path / "s").iterdir()}
    add_windows(stage, "/City/More", [(0, 0, 9)], **{"nightcity:power": [-1]})
    with pytest.raises(SceneError):
        export(stage, tmp_path / "s")
    stage.RemovePrim("/City/More")

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(NightcityError, match="No space left on device") as raised:
        export(stage, tmp_path / "s")
    assert raised.value.exit_code == 1  # worth another try, unlike a bad scene
    assert {path.name: path.read_bytes() for path in (tmp_path / "s").iterdir()} == before


def test_a_folder_that_is_a_file(tmp_path: Path) -> None:
    (tmp_path / "s").write_text("mine")
    with pytest.raises(NightcityError, match="cannot be written"):
        export(small_city(tmp_path / "a.usda"), tmp_path / "s")
    assert (tmp_path / "s").read_text() == "mine"


def test_a_scene_far_too_large(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    matrix = Gf.Matrix4d(1).SetScale(1e300)
    UsdGeom.Cube.Define(stage, "/C").AddTransformOp().Set(matrix)
    with pytest.raises(SceneError, match="further than float32 can hold"):
        export(stage, tmp_path / "s")


def test_layer_offsets_move_the_night(tmp_path: Path) -> None:
    """A sublayer that starts 10 frames later brings its events 10 frames later."""
    city = small_city(tmp_path / "city.usda")
    lit = city.GetPrimAtPath("/City/B0/Windows").GetAttribute("nightcity:lightOn")
    lit.Set([False], 1)
    lit.Set([True], 5)
    city.Save()
    stage = new_stage(tmp_path / "shot.usda")
    stage.GetRootLayer().subLayerPaths = ["city.usda"]
    stage.GetRootLayer().subLayerOffsets[0] = Sdf.LayerOffset(10)
    events = export(stage, tmp_path / "s", frames=(1, 30))["window_event"]
    assert events.tolist() == [(15, 0, 1), (15, 1, 1)]
