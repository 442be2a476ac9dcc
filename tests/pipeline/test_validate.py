# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Validation finds each fault, where it is and how bad, and nothing on a sound stage."""

from __future__ import annotations

import math
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from pxr import Gf, Sdf, Usd, UsdGeom, Vt
from stage_city import small_city

from nightcity import schemas
from nightcity.stage.contents import PRIM_TYPES
from nightcity.stage.finding import Finding
from nightcity.stage.ranges import RANGES
from nightcity.stage.validate import validate_stage
from nightcity.stage.write import write_stage

schemas.register()

WINDOWS = "/City/Buildings/Group_0000/Building_0/Windows"
OTHER_WINDOWS = "/City/Buildings/Group_0000/Building_1/Windows"
BOX = "/City/Media/Group_0000/Box_0"
OTHER_BOX = "/City/Media/Group_0000/Box_1"
NAN, INF = math.nan, math.inf


@pytest.fixture(scope="module")
def city(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_stage(small_city(), tmp_path_factory.mktemp("stage") / "city.usda")[0]


def overridden(city: Path, folder: Path, change: Callable[[Usd.Stage], None]) -> Path:
    """A stage that changes the city in a stronger layer, as an artist does."""
    stage = Usd.Stage.CreateNew(str(folder / "shot.usda"))
    stage.GetRootLayer().subLayerPaths.append(str(city))
    base = Usd.Stage.Open(str(city))
    stage.SetDefaultPrim(stage.GetPrimAtPath("/City"))
    UsdGeom.SetStageUpAxis(stage, UsdGeom.GetStageUpAxis(base))
    UsdGeom.SetStageMetersPerUnit(stage, UsdGeom.GetStageMetersPerUnit(base))
    change(stage)
    stage.Save()
    return folder / "shot.usda"


def found(path: Path, severity: str = "") -> list[Finding]:
    return [each for each in validate_stage(path) if each.severity.startswith(severity)]


def test_a_sound_stage_has_no_findings(city: Path) -> None:
    assert validate_stage(city) == []


def test_an_override_alone_is_no_fault(city: Path, tmp_path: Path) -> None:
    def change(stage: Usd.Stage) -> None:
        stage.GetPrimAtPath(BOX).GetAttribute("nightcity:extinction").Set(0.05)

    assert validate_stage(overridden(city, tmp_path, change)) == []


def put(path: str, name: str, value: object) -> Callable[[Usd.Stage], None]:
    def change(stage: Usd.Stage) -> None:
        attribute = stage.GetPrimAtPath(path).GetAttribute(name)
        assert attribute.Set(value)

    return change


def create(path: str, name: str, kind: Sdf.ValueTypeName, value: object) -> Callable:
    return lambda stage: stage.GetPrimAtPath(path).CreateAttribute(name, kind).Set(value)


def apply_by_hand(path: str, schema: str) -> Callable[[Usd.Stage], None]:
    """As a text editor would, without USD's own check."""

    def change(stage: Usd.Stage) -> None:
        spec = Sdf.CreatePrimInLayer(stage.GetRootLayer(), path)
        spec.SetInfo("apiSchemas", Sdf.TokenListOp.Create(prependedItems=[schema]))

    return change


def rotate(path: str, degrees: float) -> Callable[[Usd.Stage], None]:
    def change(stage: Usd.Stage) -> None:
        UsdGeom.Xformable(stage.GetPrimAtPath(path)).AddRotateZOp().Set(degrees)

    return change


def lit_over_time(stage: Usd.Stage) -> None:
    prim = stage.GetPrimAtPath(WINDOWS)
    for time, values in ((1, [1, 0, 1, 1]), (5, [1, 0, 1])):
        prim.GetAttribute("nightcity:lightOn").Set(Vt.BoolArray(values), time)


def switched_off_at_five(stage: Usd.Stage) -> None:
    prim = stage.GetPrimAtPath(WINDOWS)
    for time, values in ((1, [1, 0, 1, 1]), (5, [0, 0, 0, 0])):
        prim.GetAttribute("nightcity:lightOn").Set(Vt.BoolArray(values), time)


def second_ground(stage: Usd.Stage) -> None:
    stage.DefinePrim("/City/Ground2", "Mesh").ApplyAPI("NightcityGroundAPI")


FAULTS: dict[str, tuple[Callable[[Usd.Stage], object], str, str, str, str]] = {
    # what: (change, severity, prim, attribute, part of the message)
    "negative extinction": (
        put(BOX, "nightcity:extinction", -0.1), "error", BOX, "nightcity:extinction", "0 and up"),
    "extinction not a number": (
        put(BOX, "nightcity:extinction", NAN), "error", BOX, "nightcity:extinction", "is nan"),
    "albedo above 1": (
        put(BOX, "nightcity:albedo", 1.5), "error", BOX, "nightcity:albedo", "0 to 1"),
    "no reach": (
        put(BOX, "nightcity:reachScale", 0.0), "error", BOX, "nightcity:reachScale", "above 0"),
    "no mediaId": (
        lambda stage: stage.GetPrimAtPath(BOX).GetAttribute("nightcity:mediaId").Block(),
        "error", BOX, "nightcity:mediaId", "must be set"),
    "mediaId twice": (
        put(OTHER_BOX, "nightcity:mediaId", 0), "error", OTHER_BOX, "nightcity:mediaId", BOX),
    "unknown window listed": (
        put(BOX, "nightcity:windowLights", Vt.IntArray([0, 99])),
        "error", BOX, "nightcity:windowLights", "window 99"),
    "list out of order": (
        put(BOX, "nightcity:windowLights", Vt.IntArray([1, 0])),
        "warning", BOX, "nightcity:windowLights", "sort"),
    "stale list": (
        put(BOX, "nightcity:windowLights", Vt.IntArray([2])),
        "warning", BOX, "nightcity:windowLights", "no longer fits"),
    "strange source": (
        lambda stage: stage.GetPrimAtPath(BOX)
        .GetRelationship("nightcity:windowLightSources").AddTarget("/City/Ground"),
        "warning", BOX, "nightcity:windowLightSources", "/City/Ground"),
    "turned box": (rotate(BOX, 30), "error", BOX, "xformOpOrder", "turned"),
    "turned parent": (rotate("/City/Media", 1), "error", BOX, "xformOpOrder", "turned"),
    "overlap": (
        put(OTHER_BOX, "xformOp:translate", Gf.Vec3d(29, -5, 15)),
        "error", OTHER_BOX, "xformOpOrder", f"overlaps {BOX}"),
    "flat box": (
        put(BOX, "xformOp:scale", Gf.Vec3d(10, 5, 0)), "error", BOX, "size", "flat"),
    "hidden purpose": (put(BOX, "purpose", "guide"), "warning", BOX, "purpose", "guide"),
    "box without its schema": (
        create("/City/Ground", "nightcity:mediaId", Sdf.ValueTypeNames.Int, 3),
        "error", "/City/Ground", "nightcity:mediaId", "NightcityMediaAPI"),
    "misspelt attribute": (
        create(WINDOWS, "nightcity:ligthOn", Sdf.ValueTypeNames.BoolArray, Vt.BoolArray([True])),
        "warning", WINDOWS, "nightcity:ligthOn", "did you mean nightcity:lightOn"),
    "misspelt schema": (
        apply_by_hand("/City/Ground", "NightcityMediumAPI"),
        "error", "/City/Ground", "apiSchemas", "did you mean NightcityMediaAPI"),
    "schema on the wrong type": (
        apply_by_hand("/City/Ground", "NightcityWindowsAPI"),
        "error", "/City/Ground", "apiSchemas", "PointInstancer"),
    "wrong type of attribute": (
        lambda stage: Sdf.AttributeSpec(
            Sdf.CreatePrimInLayer(stage.GetRootLayer(), WINDOWS),
            "nightcity:windowSize", Sdf.ValueTypeNames.String),
        "error", WINDOWS, "nightcity:windowSize", "float2"),
    "too few powers": (
        put(WINDOWS, "nightcity:power", Vt.FloatArray([1, 2, 3])),
        "error", WINDOWS, "nightcity:power", "has 3 values, but protoIndices has 4"),
    "no power": (
        put(WINDOWS, "nightcity:power", Vt.FloatArray()), "error", WINDOWS, "nightcity:power", "0"),
    "infinite power": (
        put(WINDOWS, "nightcity:power", Vt.FloatArray([INF])),
        "error", WINDOWS, "nightcity:power", "inf"),
    "negative colour": (
        put(WINDOWS, "nightcity:color", Vt.Vec3fArray([Gf.Vec3f(1, -1, 1)])),
        "error", WINDOWS, "nightcity:color", "-1"),
    "flat windows": (
        put(WINDOWS, "nightcity:windowSize", Gf.Vec2f(0, 1)),
        "error", WINDOWS, "nightcity:windowSize", "above 0"),
    "lengths over time": (
        lit_over_time, "error", WINDOWS, "nightcity:lightOn", "has 3 values at time 5"),
    "too few positions": (
        put(WINDOWS, "positions", Vt.Vec3fArray(3)), "error", WINDOWS, "positions", "give it 4"),
    "positions not finite": (
        put(WINDOWS, "positions", Vt.Vec3fArray([Gf.Vec3f(NAN)] * 4)),
        "error", WINDOWS, "positions", "finite"),
    "scale of nothing": (
        put(WINDOWS, "scales", Vt.Vec3fArray([Gf.Vec3f(1, 0, 1)] * 4)),
        "error", WINDOWS, "scales", "0"),
    "no rotation": (
        put(WINDOWS, "orientationsf", Vt.QuatfArray([Gf.Quatf(0)] * 4)),
        "error", WINDOWS, "orientationsf", "length 1"),
    "two orientations": (
        put(WINDOWS, "orientations", Vt.QuathArray([Gf.Quath(1)] * 4)),
        "warning", WINDOWS, "orientations", "orientationsf"),
    "no prototype of that number": (
        put(WINDOWS, "protoIndices", Vt.IntArray([0, 1, 2, 9])),
        "error", WINDOWS, "protoIndices", "0 to 9"),
    "prototype missing": (
        lambda stage: stage.GetPrimAtPath(WINDOWS)
        .GetRelationship("prototypes").SetTargets(["/City/Nothing"]),
        "error", WINDOWS, "prototypes", "/City/Nothing"),
    "dark but shown lit": (
        put(WINDOWS, "nightcity:lightOn", Vt.BoolArray([False])),
        "warning", WINDOWS, "protoIndices", "3 of 4"),
    "lit but shown dark": (
        put(WINDOWS, "protoIndices", Vt.IntArray([0, 0, 0, 0])),
        "warning", WINDOWS, "protoIndices", "3 of 4"),
    "dark from frame 5 but shown lit": (
        switched_off_at_five, "warning", WINDOWS, "protoIndices", "at time 5"),
    "ids twice in one": (
        put(WINDOWS, "ids", Vt.Int64Array([0, 1, 2, 2])), "error", WINDOWS, "ids", "window 2"),
    "ids twice in two": (
        put(OTHER_WINDOWS, "ids", Vt.Int64Array([4, 5, 6, 0])),
        "error", OTHER_WINDOWS, "ids", WINDOWS),
    "negative id": (
        put(WINDOWS, "ids", Vt.Int64Array([-1, 1, 2, 3])), "error", WINDOWS, "ids", "0 to"),
    "no ids": (put(WINDOWS, "ids", Vt.Int64Array()), "warning", WINDOWS, "ids", "number them"),
    "sloping ground": (
        lambda stage: UsdGeom.Xformable(stage.GetPrimAtPath("/City/Ground")).AddRotateXOp().Set(1),
        "error", "/City/Ground", "points", "horizontal"),
    "two grounds": (second_ground, "error", "/City/Ground2", "apiSchemas", "/City/Ground"),
    "parameters": (
        put("/City", "nightcity:parameters", "{"),
        "error", "/City", "nightcity:parameters", "JSON"),
    "building number twice": (
        put("/City/Buildings/Group_0000/Building_1", "nightcity:buildingId", 0),
        "error", "/City/Buildings/Group_0000/Building_1", "nightcity:buildingId", "Building_0"),
    "origin": (
        put("/City", "nightcity:originOffset", Gf.Vec3d(0, INF, 0)),
        "error", "/City", "nightcity:originOffset", "finite"),
    "units": (
        lambda stage: UsdGeom.SetStageMetersPerUnit(stage, -1.0),
        "error", "", "metersPerUnit", "above 0"),
    "no camera": (
        lambda stage: stage.GetPrimAtPath("/City/Cameras").SetActive(False),
        "warning", "", "", "no camera"),
    "no windows": (
        lambda stage: stage.GetPrimAtPath("/City/Buildings").SetActive(False),
        "warning", "", "", "no windows"),
    "no haze": (
        lambda stage: stage.GetPrimAtPath("/City/Media").SetActive(False),
        "warning", "", "", "no haze"),
    "missing sublayer": (
        lambda stage: stage.GetRootLayer().subLayerPaths.append("./gone.usda"),
        "error", "", "", "gone.usda"),
    "missing texture": (
        lambda stage: stage.GetPrimAtPath("/City/Looks/wall/Texture")
        .GetAttribute("inputs:file").Set(Sdf.AssetPath("./gone.png")),
        "error", "", "", "gone.png"),
}  # fmt: skip


@pytest.mark.parametrize("what", FAULTS)
def test_each_fault_is_found(what: str, city: Path, tmp_path: Path) -> None:
    change, severity, prim, attribute, words = FAULTS[what]
    findings = validate_stage(overridden(city, tmp_path, change))
    hits = [
        each
        for each in findings
        if (each.severity, each.prim, each.attribute) == (severity, prim, attribute)
        and words in each.message
    ]
    assert hits, "\n".join(map(str, findings))


@pytest.mark.parametrize("degrees", [90, 180, 270])
def test_quarter_turns_are_no_fault(degrees: float, city: Path, tmp_path: Path) -> None:
    stage = overridden(city, tmp_path, rotate("/City", degrees))
    assert found(stage, "error") == []


@pytest.mark.parametrize("name", ["positions", "nightcity:lightOn", "ids", "nightcity:power"])
def test_attributes_of_any_type_do_not_stop_it(name: str, city: Path, tmp_path: Path) -> None:
    def change(stage: Usd.Stage) -> None:
        spec = Sdf.CreatePrimInLayer(stage.GetRootLayer(), WINDOWS)
        attribute = Sdf.AttributeSpec(spec, name, Sdf.ValueTypeNames.StringArray)
        attribute.default = Vt.StringArray(["a", "b"])

    assert any(name == each.attribute for each in found(overridden(city, tmp_path, change)))


def test_faults_are_found_in_another_unit_and_up_axis(tmp_path: Path) -> None:
    stage = Usd.Stage.CreateNew(str(tmp_path / "y_up.usda"))
    UsdGeom.SetStageUpAxis(stage, "Y")
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    for number, height in enumerate((0.0, 500.0)):
        ground = UsdGeom.Mesh.Define(stage, f"/Ground_{number}")
        points = np.array([(0, 0, 0), (900, 0, 0), (900, height, 900), (0, height, 900)])
        ground.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(points.astype(np.float32)))
        ground.GetPrim().ApplyAPI("NightcityGroundAPI")
    stage.Save()
    grounds = [each for each in found(tmp_path / "y_up.usda") if each.attribute == "points"]
    assert [each.prim for each in grounds] == ["/Ground_1"]
    assert "from 0 to 5 m" in grounds[0].message


@pytest.mark.parametrize(
    "content", [b"", b"#usda 1.0\n(", b"PXR-USDC\0\0", b"\xff\xfe\0", b'def "Broken"']
)
def test_what_is_no_stage_is_one_finding(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "broken.usda"
    path.write_bytes(content)
    (finding,) = validate_stage(path)
    assert finding.severity == "error" and "broken.usda" in finding.message


def test_a_missing_file_is_one_finding(tmp_path: Path) -> None:
    (finding,) = validate_stage(tmp_path / "gone.usda")
    assert (finding.severity, finding.prim) == ("error", "") and "gone.usda" in finding.message


def test_a_truncated_layer_is_found(tmp_path: Path) -> None:
    root, _, _, windows, *_ = write_stage(small_city(), tmp_path / "city.usda")
    windows.write_bytes(windows.read_bytes()[:1000])
    assert any("windows.usdc" in str(each) for each in found(root, "error"))


def test_an_empty_stage_lacks_everything(tmp_path: Path) -> None:
    (tmp_path / "empty.usda").write_text("#usda 1.0\n")
    text = "\n".join(map(str, validate_stage(tmp_path / "empty.usda")))
    for words in ("no windows", "no haze", "no camera", "metersPerUnit", "upAxis"):
        assert words in text


def test_schemas_that_come_too_late_are_a_finding(city: Path) -> None:
    code = (
        "import sys; from pathlib import Path; from pxr import Usd\n"
        "Usd.SchemaRegistry().FindAppliedAPIPrimDefinition('CollectionAPI')\n"
        "from nightcity.stage.validate import validate_stage\n"
        "print(*validate_stage(Path(sys.argv[1])))"
    )
    done = subprocess.run([sys.executable, "-c", code, city], capture_output=True, text=True)
    assert "error: the stage: USD does not know the schemas" in done.stdout


def test_usd_does_not_also_print_what_is_found(city: Path, tmp_path: Path) -> None:
    path = overridden(city, tmp_path, FAULTS["missing sublayer"][0])
    code = (
        "import sys; from pathlib import Path\n"
        "from nightcity.stage.validate import validate_stage\n"
        "validate_stage(Path(sys.argv[1]))"
    )
    done = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_ranges_agree_with_the_schema() -> None:
    registry = Usd.SchemaRegistry()
    for schema in schemas.NAMES:
        definition = registry.FindAppliedAPIPrimDefinition(schema)
        for name in definition.GetPropertyNames():
            doc = definition.GetPropertyDocumentation(name)
            if name in RANGES:
                assert f"; range: {RANGES[name]}" in doc, f"{name}: {doc}"
            else:
                assert name in {
                    "nightcity:crs",
                    "nightcity:parameters",
                    "nightcity:lightOn",
                    "nightcity:windowLights",
                    "nightcity:windowLightSources",
                }


def test_prim_types_agree_with_the_schema() -> None:
    for schema in schemas.NAMES:
        allowed = Usd.SchemaRegistry.GetAPISchemaCanOnlyApplyToTypeNames(schema)
        assert list(allowed) == [PRIM_TYPES[schema]] if schema in PRIM_TYPES else not allowed


def test_validation_knows_neither_city_nor_export() -> None:
    code = (
        "import sys, nightcity.stage.validate\n"
        "print([name for name in sys.modules if name.startswith(('nightcity.city',"
        " 'nightcity.export'))])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout.strip() == "[]", done.stderr
