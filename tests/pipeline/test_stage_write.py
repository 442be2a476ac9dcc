# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The files of a stage: which there are, what they hold, and what is left when writing fails."""

from __future__ import annotations

import math
import os
import shutil
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest
from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade, UsdUtils, UsdValidation
from stage_city import BRICKS, small_city

from nightcity.city.model import Camera, City
from nightcity.errors import SceneError, UsageError
from nightcity.stage.write import write_stage

FILES = [
    "city.usda",
    "city.cameras.usda",
    "city.media.usdc",
    "city.windows.usdc",
    "city.geometry.usdc",
    "city.textures/wall.png",
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("stage")
    assert write_stage(small_city(), folder / "city.usda") == [folder / name for name in FILES]
    return folder


@pytest.fixture
def stage(folder: Path) -> Usd.Stage:
    return Usd.Stage.Open(str(folder / "city.usda"))


def tree(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def test_nothing_else_is_left_in_the_folder(folder: Path) -> None:
    assert sorted(tree(folder)) == sorted(FILES)


def test_usd_has_no_objection(stage: Usd.Stage) -> None:
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) >= 25
    found = UsdValidation.ValidationContext(validators).Validate(stage)
    assert [error.GetMessage() for error in found] == []


@pytest.mark.parametrize("name", ["cameras.usda", "media.usdc", "geometry.usdc"])
def test_each_sublayer_opens_alone(folder: Path, name: str) -> None:
    alone = Usd.Stage.Open(str(folder / f"city.{name}"))
    assert alone.GetDefaultPrim().GetPath() == "/City"
    assert UsdGeom.GetStageUpAxis(alone) == "Z" and UsdGeom.GetStageMetersPerUnit(alone) == 1


def test_conventions_of_the_stage(stage: Usd.Stage) -> None:
    root = stage.GetDefaultPrim()
    assert Usd.ModelAPI(root).GetKind() == "assembly"
    assert (UsdGeom.GetStageUpAxis(stage), UsdGeom.GetStageMetersPerUnit(stage)) == ("Z", 1.0)
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (1, 1)
    building = stage.GetPrimAtPath("/City/Buildings/Group_0000/Building_1")
    assert Usd.ModelAPI(building).IsModel() and building.GetDisplayName() == "House 1"
    assert building.GetAttribute("xformOp:translate").Get() == Gf.Vec3d(20, 0, 0)
    assert building.GetAttribute("nightcity:buildingId").Get() == 1
    assert root.GetAttribute("nightcity:crs").Get() == "EPSG:7415"
    assert root.GetAttribute("nightcity:originOffset").Get() == Gf.Vec3d(84000, 447000, 0)
    assert root.GetAttribute("nightcity:parameters").Get() == '{"grid": 2, "seed": 7}'


def test_each_layer_holds_one_thing(folder: Path) -> None:
    def defined(name: str) -> set[str]:
        layer, found = Sdf.Layer.FindOrOpen(str(folder / f"city.{name}")), set()

        def visit(path: Sdf.Path) -> None:
            prim = layer.GetPrimAtPath(path) if path.IsPrimPath() else None
            if prim and prim.specifier == Sdf.SpecifierDef:
                found.add(prim.typeName)

        layer.Traverse("/", visit)
        return found - {"Xform", "Scope", "Material", "Shader"}

    assert defined("cameras.usda") == {"Camera"}
    assert defined("media.usdc") == {"Cube"}
    assert defined("windows.usdc") == {"PointInstancer", "Mesh"}
    assert defined("geometry.usdc") == {"Mesh", "GeomSubset"}
    assert defined("usda") == {"RenderSettings", "RenderProduct", "RenderVar"}


def test_no_path_of_this_machine_is_in_the_files(folder: Path) -> None:
    for name, content in tree(folder).items():
        assert str(folder).encode() not in content, name
        assert os.uname().nodename.encode() not in content, name


def test_the_stage_can_be_moved(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder, tmp_path / "elsewhere")
    layers, assets, missing = UsdUtils.ComputeAllDependencies(str(tmp_path / "elsewhere/city.usda"))
    assert (len(layers), len(assets), missing) == (5, 1, [])
    assert all(str(tmp_path) in layer.realPath for layer in layers)


def test_walls_and_roof_have_their_materials(stage: Usd.Stage) -> None:
    shell = UsdGeom.Mesh.Get(stage, "/City/Buildings/Group_0000/Building_0/Shell")
    bound = {
        subset.GetPrim().GetName(): list(subset.GetIndicesAttr().Get())
        for subset in UsdShade.MaterialBindingAPI(shell).GetMaterialBindSubsets()
    }
    assert bound == {"wall": [0, 1, 2, 3], "roof": [4, 5]}
    surface = UsdShade.Material.Get(stage, "/City/Looks/wall").ComputeSurfaceSource()[0]
    texture = UsdShade.Shader(surface.GetInput("diffuseColor").GetConnectedSource()[0])
    assert texture.GetInput("scale").Get() == Gf.Vec4f(0.5, 0.4, 0.3, 1)
    pixels = OpenImageIO.ImageBuf(texture.GetInput("file").Get().resolvedPath)
    assert np.array_equal(pixels.get_pixels(OpenImageIO.UINT8), BRICKS)
    st = UsdGeom.PrimvarsAPI(shell).GetPrimvar("st")
    assert (st.GetInterpolation(), len(st.Get())) == ("faceVarying", 24)


def test_ground_is_wider_than_the_city(stage: Usd.Stage) -> None:
    ground = stage.GetPrimAtPath("/City/Ground")
    assert "NightcityGroundAPI" in ground.GetAppliedSchemas()
    points = np.array(ground.GetAttribute("points").Get())
    assert (points[:, 2] == 0).all()
    assert points[:, :2].min() < -1000 and points[:, :2].max() > 1000


@pytest.mark.parametrize("camera", small_city().cameras, ids=lambda camera: camera.name)
def test_camera_looks_where_it_should(stage: Usd.Stage, camera: Camera) -> None:
    prim = UsdGeom.Camera.Get(stage, f"/City/Cameras/{camera.name}")
    seen = prim.GetCamera(Usd.TimeCode.Default())
    fov = seen.GetFieldOfView(Gf.Camera.FOVVertical)
    assert fov == pytest.approx(camera.vertical_fov_degrees, rel=1e-6)
    assert seen.horizontalAperture / seen.verticalAperture == pytest.approx(1920 / 1061, rel=1e-6)
    frustum = seen.frustum
    assert frustum.GetPosition() == Gf.Vec3d(*camera.position)
    forward = (Gf.Vec3d(*camera.target) - Gf.Vec3d(*camera.position)).GetNormalized()
    assert Gf.IsClose(frustum.ComputeViewDirection(), forward, 1e-12)
    up = frustum.ComputeUpVector()
    assert up[2] > 0 and abs(Gf.Cross(up, forward)[2]) < 1e-12  # the horizon is level
    near, far = prim.GetClippingRangeAttr().Get()
    assert 0.1 <= near < far and far > 1000
    assert prim.GetFocusDistanceAttr().Get() == pytest.approx(
        math.dist(camera.position, camera.target)
    )


def test_a_camera_may_look_straight_down(tmp_path: Path) -> None:
    city = replace(small_city(), cameras=(Camera("down", (0, 0, 100), (0, 0, 0), 45),))
    stage = Usd.Stage.Open(str(write_stage(city, tmp_path / "city.usda")[0]))
    frustum = UsdGeom.Camera.Get(stage, "/City/Cameras/down").GetCamera(0).frustum
    assert frustum.ComputeViewDirection() == Gf.Vec3d(0, 0, -1)
    assert frustum.ComputeUpVector() == Gf.Vec3d(0, 1, 0)


def test_render_settings(stage: Usd.Stage) -> None:
    settings = stage.GetPrimAtPath(stage.GetMetadata("renderSettingsPrimPath"))
    assert settings.GetAttribute("resolution").Get() == Gf.Vec2i(1920, 1061)
    assert settings.GetRelationship("camera").GetTargets() == ["/City/Cameras/overview"]
    (product,) = settings.GetRelationship("products").GetTargets()
    channels = stage.GetPrimAtPath(product).GetRelationship("orderedVars").GetTargets()
    names = [stage.GetPrimAtPath(path).GetAttribute("sourceName").Get() for path in channels]
    assert names == ["beauty", "glow", "surface", "transmittance"] + [
        "depth",
        "normal",
        "mediaId",
        "materialId",
    ]


def test_more_than_a_hundred_siblings_are_grouped(tmp_path: Path) -> None:
    city = small_city(230)
    stage = Usd.Stage.Open(str(write_stage(city, tmp_path / "city.usda")[0]))
    for holder in ("Buildings", "Media"):
        groups = stage.GetPrimAtPath(f"/City/{holder}").GetChildren()
        assert [len(group.GetChildren()) for group in groups] == [100, 100, 30]


_WRITE = """
import sys
import time
sys.path.insert(0, {tests!r})
from pathlib import Path
from stage_city import small_city
from nightcity.stage.write import write_stage
{before}
write_stage(small_city({count}), Path(sys.argv[1]))
"""


def write_elsewhere(path: Path, before: str = "", count: int = 2) -> subprocess.CompletedProcess:
    code = _WRITE.format(tests=str(Path(__file__).parent), before=before, count=count)
    return subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True)


def test_same_city_same_bytes_in_another_process(folder: Path, tmp_path: Path) -> None:
    write_elsewhere(tmp_path / "city.usda").check_returncode()
    assert tree(tmp_path) == tree(folder)


@pytest.mark.parametrize("limit", [100, 1000, 3000])
def test_a_full_disk_leaves_what_was_there(folder: Path, tmp_path: Path, limit: int) -> None:
    """A limit on file sizes stands for a full disk: small, so that different files hit it."""
    shutil.copytree(folder, tmp_path, dirs_exist_ok=True)
    full = (
        "import resource, signal\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        f"resource.setrlimit(resource.RLIMIT_FSIZE, ({limit}, {limit}))"
    )
    done = write_elsewhere(tmp_path / "city.usda", full, count=50)
    assert done.returncode != 0 and "NightcityError: cannot write" in done.stderr
    assert tree(tmp_path) == tree(folder)


def test_an_unwritable_folder_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    done = write_elsewhere(tmp_path / "file" / "city.usda")
    assert "NightcityError: cannot write" in done.stderr and "file" in done.stderr


def test_a_stage_that_is_open_sees_the_new_files(tmp_path: Path) -> None:
    stage = Usd.Stage.Open(str(write_stage(small_city(2), tmp_path / "city.usda")[0]))
    write_stage(small_city(3), tmp_path / "city.usda")
    assert stage.GetPrimAtPath("/City/Buildings/Group_0000/Building_2/Windows")


@pytest.mark.parametrize("name", ["city.usdc", "city.usd", "city"])
def test_the_root_layer_is_text(tmp_path: Path, name: str) -> None:
    with pytest.raises(UsageError, match=r"\.usda"):
        write_stage(small_city(), tmp_path / name)


def bad_cities() -> dict[str, tuple[City, str]]:
    city = small_city()
    first = city.buildings[0]

    def building(**changes: object) -> City:
        return replace(city, buildings=(replace(first, **changes), *city.buildings[1:]))

    def windows(**changes: object) -> City:
        return building(windows=replace(first.windows, **changes))

    def mesh(**changes: object) -> City:
        return building(mesh=replace(first.mesh, **changes))

    def box(**changes: object) -> City:
        return replace(city, media=(replace(city.media[0], **changes), *city.media[1:]))

    nan = np.full((4, 3), np.nan)
    lists = city.light_lists
    return {
        "name": (replace(city, name="my city"), "name"),
        "two buildings, one id": (building(building_id=1), "building_id"),
        "origin": (building(origin=np.array([np.nan, 0, 0])), "building 0: origin"),
        "nan in a window": (windows(centres=nan), "windows.centres"),
        "too few powers": (windows(power=np.ones(3)), "windows.power"),
        "negative power": (windows(power=-np.ones(4)), "windows.power"),
        "no width": (windows(half_u=np.zeros((4, 3))), "windows.half_u"),
        "a skewed pane": (windows(half_u=first.windows.half_u + [0, 0, 0.1]), "right angles"),
        "ids twice": (windows(ids=np.array([0, 1, 1, 2])), "window id 1"),
        "huge id": (windows(ids=np.array([0, 1, 2, 2**31])), "windows.ids"),
        "index": (mesh(indices=np.full(24, 8)), "mesh.indices"),
        "short face": (mesh(counts=np.array([2, 4, 4, 4, 4, 6])), "mesh.counts"),
        "material": (mesh(materials=np.full(6, 3)), "mesh.materials"),
        "texcoords": (mesh(texcoords=np.zeros((5, 2))), "mesh.texcoords"),
        "box inside out": (box(lo=np.array([30.0, -10, 0])), "media box 0: lo and hi"),
        "albedo": (box(albedo=1.1), "albedo"),
        "extinction": (box(extinction=math.nan), "extinction"),
        "media ids": (box(media_id=1), "media_id"),
        "lists": (
            replace(city, light_lists=replace(lists, window_ids=lists.window_ids + 1000)),
            "light_lists.window_ids",
        ),
        "offsets": (
            replace(city, light_lists=replace(lists, offsets=lists.offsets[:-1])),
            "light_lists.offsets",
        ),
        "fov": (replace(city, cameras=(Camera("c", (0, 0, 0), (1, 0, 0), 180.0),)), "fov"),
        "target": (replace(city, cameras=(Camera("c", (1, 0, 0), (1, 0, 0), 60.0),)), "target"),
        "camera name": (replace(city, cameras=(Camera("1 c", (0,) * 3, (1,) * 3, 60),)), "name"),
        "reflectance": (
            replace(city, materials=(replace(city.materials[0], reflectance=(2, 0, 0)),) * 1),
            "reflectance",
        ),
        "ground": (replace(city, ground_material=9), "ground_material"),
        "parameters": (replace(city, parameters={"x": object()}), "parameters"),
    }


@pytest.mark.parametrize("what", bad_cities())
def test_bad_records_are_named_and_nothing_is_written(what: str, tmp_path: Path) -> None:
    city, expected = bad_cities()[what]
    with pytest.raises(SceneError, match=expected):
        write_stage(city, tmp_path / "city.usda")
    assert tree(tmp_path) == {}


def test_cost_grows_with_the_city_and_no_faster(tmp_path: Path) -> None:
    """Thousands of siblings must not go quadratic, as they do through the Usd API."""

    def seconds(count: int) -> float:
        city = small_city(count)
        start = time.process_time()
        write_stage(city, tmp_path / "city.usda")
        return time.process_time() - start

    seconds(10)  # loads what is loaded once
    assert seconds(3200) < 3 * 8 * seconds(400)
