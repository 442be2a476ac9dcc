# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Opaque geometry: triangles, winding, materials, textures, the ground."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO
import pytest
from export_maker import SQUARE, Scene, add_building, add_mesh, export, new_stage
from numpy.testing import assert_allclose
from pxr import Sdf, Usd, UsdGeom, UsdLux, UsdShade, UsdUtils

from nightcity.errors import SceneError
from nightcity.export.export_stage import export_stage
from nightcity.export.triangulate import triangulate

POINTS, FACES = SQUARE
# An L of area 3, an arrow head whose first corner fans outside, and a polygon around a hole that
# a bridge joins to its rim.
CONCAVE = {
    "L": [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)],
    "L from its notch": [(1, 2), (0, 2), (0, 0), (2, 0), (2, 1), (1, 1)],
    "arrow": [(0, 0), (4, 1), (0, 2), (1, 1)],
    "bridge": [(0, 0), (4, 0), (4, 4), (0, 4), (0, 0), (1, 1), (1, 3), (3, 3), (3, 1), (1, 1)],
}


def areas(scene: Scene) -> np.ndarray:
    """(T, 3) area vectors of the triangles, m^2."""
    corner = scene.corners().astype(float)
    return 0.5 * np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])


def volume(scene: Scene) -> float:
    """Of a closed surface; positive where its triangles are wound outward."""
    corner = scene.corners().astype(float)
    return float(np.linalg.det(corner).sum() / 6)


def shoelace(loop: list[tuple[float, float]]) -> float:
    x, y = np.array(loop, float).T
    return float(0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum())


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("name", CONCAVE)
def test_concave_polygons(name: str, axis: int, turned: bool) -> None:
    """Every triangle turns as its polygon does, and they add up to its area."""
    loop = CONCAVE[name][::-1] if turned else CONCAVE[name]
    points = np.insert(np.array(loop, float), axis, 7.0, axis=1)
    corners, faces = triangulate(points, np.array([len(loop)]), np.arange(len(loop)))
    p = points[corners]
    found = 0.5 * np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    sign = -1 if axis == 1 else 1  # a loop in x and z is seen from -y
    assert (faces == 0).all()
    assert (found[:, axis] * sign * shoelace(loop) >= 0).all()
    assert_allclose(found.sum(axis=0)[axis], sign * shoelace(loop))
    assert_allclose(np.abs(found[:, axis]).sum(), abs(shoelace(loop)))


def test_faces_of_many_sizes_keep_their_order() -> None:
    points = np.array([(np.cos(a), np.sin(a), 0) for a in np.linspace(0, 6, 8)])
    counts = np.array([3, 2, 5, 4, 8, 0, 3])
    indices = np.concatenate([np.arange(n) for n in counts])
    corners, faces = triangulate(points, counts, indices)
    assert faces.tolist() == [0] + [2] * 3 + [3] * 2 + [4] * 6 + [6]
    assert (corners >= (np.cumsum(counts) - counts)[faces][:, None]).all()
    assert (corners < np.cumsum(counts)[faces][:, None]).all()


def test_a_mesh_in_a_building_and_one_in_none(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_mesh(stage, "/Loose", POINTS, FACES)
    add_building(stage, "/B", 3).AddTranslateOp().Set((10, 0, 0))
    add_mesh(stage, "/B/Shell", POINTS, FACES)
    scene = export(stage, tmp_path / "s")
    assert scene["building"].tolist() == [(0, 2, 0, 0, 3)]
    assert_allclose(scene.corners()[:2].mean(axis=(0, 1)), (10.5, 0.5, 0), atol=0.2)
    assert_allclose(areas(scene).sum(axis=0), (0, 0, 2))
    assert len(scene["texcoord"]) == 0


def test_left_handed_holes_and_faces_without_area(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    points = [*POINTS, (2, 0, 0), (2, 1, 0)]
    faces = [[0, 1, 2, 3], [1, 4, 5, 2], [0, 1, 1], [0, 1, 4], [2, 3]]
    mesh = add_mesh(stage, "/M", points, faces, orientation="leftHanded", holeIndices=[1])
    scene = export(stage, tmp_path / "s")
    assert_allclose(areas(scene).sum(axis=0), (0, 0, -1))
    assert len(scene["triangle"]) == 2
    assert "2 triangles without area are dropped." in scene.notes
    mesh.CreateSubdivisionSchemeAttr("catmullClark")
    assert "control cage: /M." in export(stage, tmp_path / "s").notes


@pytest.mark.parametrize("scale", [(1, 1, 1), (-1, 1, 1), (1, -2, 1), (-1, -1, -1)])
@pytest.mark.parametrize(
    ("kind", "wanted", "share"),
    [
        ("Cube", 8.0, 1e-6),
        ("Sphere", 4 / 3 * np.pi, 5e-3),
        ("Cylinder", 2 * np.pi, 2e-3),
        ("Cylinder_1", 2 * np.pi, 2e-3),
        ("Cone", 2 / 3 * np.pi, 2e-3),
        ("Capsule", np.pi * (1 + 4 / 3), 5e-3),
        ("Capsule_1", np.pi * (1 + 4 / 3), 5e-3),
    ],
)
def test_implicit_surfaces(
    tmp_path: Path, kind: str, wanted: float, share: float, scale: tuple[int, int, int]
) -> None:
    """Closed and wound outward: the volume is the shape's own, also mirrored."""
    stage = new_stage(tmp_path / "a.usda")
    prim = stage.DefinePrim("/P", kind)
    for name, value in {
        "size": 2, "radius": 1, "radiusTop": 1, "radiusBottom": 1, "axis": "Z",
        "height": 1 if kind.startswith("Capsule") else 2,
    }.items():  # fmt: skip
        if prim.GetAttribute(name):
            prim.GetAttribute(name).Set(value)
    UsdGeom.Xformable(prim).AddScaleOp().Set(scale)
    found = volume(export(stage, tmp_path / "s"))
    assert_allclose(found, wanted * abs(np.prod(scale)), rtol=share)


@pytest.mark.parametrize("axis", "XYZ")
def test_axis_of_an_implicit_surface(tmp_path: Path, axis: str) -> None:
    stage = new_stage(tmp_path / "a.usda")
    cone = UsdGeom.Cone.Define(stage, "/P")
    cone.CreateAxisAttr(axis)
    cone.CreateHeightAttr(6)
    scene = export(stage, tmp_path / "s")
    assert volume(scene) > 0
    tip = scene["position"]["position"][:, "XYZ".index(axis)]
    assert (tip.min(), tip.max()) == (-3, 3)
    assert (tip == 3).sum() == 64  # the tip is at the positive end


def test_a_plane(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    plane = UsdGeom.Plane.Define(stage, "/P")
    plane.CreateWidthAttr(3)
    plane.CreateLengthAttr(4)
    assert_allclose(areas(export(stage, tmp_path / "s")).sum(axis=0), (0, 0, 12))


def test_other_gprims_are_named(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    UsdGeom.BasisCurves.Define(stage, "/Wire")
    UsdGeom.Mesh.Define(stage, "/Empty")
    add_mesh(stage, "/M", POINTS, FACES)
    UsdLux.MeshLightAPI.Apply(stage.GetPrimAtPath("/M"))
    scene = export(stage, tmp_path / "s")
    assert "Geometry of type BasisCurves is left out; use a Mesh: /Wire." in scene.notes
    assert "A mesh without points or faces is left out: /Empty." in scene.notes
    assert "Light of geometry is left out, its surfaces are kept: /M." in scene.notes
    assert len(scene["triangle"]) == 2


@pytest.mark.parametrize(
    ("name", "value", "wanted"),
    [
        ("points", [(0, 0, 0), (1, 0, 0), (1, 1, float("nan")), (0, 1, 0)], "/M.points"),
        ("faceVertexIndices", [0, 1, 2, 4], "between 0 and 3, but reaches 0 and 4"),
        ("faceVertexIndices", [0, 1, 2, -1], "between 0 and 3, but reaches -1 and 2"),
        ("faceVertexCounts", [5], "adds up to 5, but faceVertexIndices has 4"),
        ("faceVertexCounts", [-4, 8], "adds up to 4"),
    ],
)
def test_bad_meshes_are_named(tmp_path: Path, name: str, value: list, wanted: str) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_mesh(stage, "/M", POINTS, FACES, **{name: value})
    with pytest.raises(SceneError) as error:
        export(stage, tmp_path / "s")
    assert "/M." in str(error.value) and wanted in str(error.value)


def test_transforms_that_are_not_finite(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_mesh(stage, "/M", POINTS, FACES).AddTranslateOp().Set((float("inf"), 0, 0))
    with pytest.raises(SceneError, match="/M: its transform is not finite"):
        export(stage, tmp_path / "s")


def add_material(
    stage: Usd.Stage, name: str, color: tuple[float, float, float] | None = None
) -> tuple[UsdShade.Material, UsdShade.Shader]:
    material = UsdShade.Material.Define(stage, f"/Looks/{name}")
    shader = UsdShade.Shader.Define(stage, f"/Looks/{name}/Surface")
    shader.CreateIdAttr("UsdPreviewSurface")
    if color is not None:
        shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set(color)
    material.CreateSurfaceOutput().ConnectToSource(shader.ConnectableAPI(), "surface")
    return material, shader


def bind(prim: Usd.Prim, material: UsdShade.Material) -> None:
    UsdShade.MaterialBindingAPI.Apply(prim).Bind(material)


TWO_FACES = ([*POINTS, (2, 0, 0), (2, 1, 0)], [[0, 1, 2, 3], [1, 4, 5, 2]])


def test_materials_by_subset_and_inherited(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    red, blue = add_material(stage, "Red", (1, 0, 0))[0], add_material(stage, "Blue", (0, 0, 1))[0]
    UsdGeom.Xform.Define(stage, "/A")
    bind(stage.GetPrimAtPath("/A"), red)
    mesh = add_mesh(stage, "/A/M", *TWO_FACES)
    subset = UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).CreateMaterialBindSubset("b", [1])
    bind(subset.GetPrim(), blue)
    scene = export(stage, tmp_path / "s")
    shown = scene["material"]["reflectance"][scene["triangle"]["material"]]
    assert shown.tolist() == [[1, 0, 0]] * 2 + [[0, 0, 1]] * 2
    assert scene["material"]["first_texel"].tolist() == [0xFFFFFFFF] * 2
    subset.GetIndicesAttr().Set([2])
    with pytest.raises(SceneError, match=r"/A/M/b.indices must lie between 0 and 1"):
        export(stage, tmp_path / "t")


def test_a_material_that_an_interface_input_drives(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    material, shader = add_material(stage, "M")
    knob = material.CreateInput("paint", Sdf.ValueTypeNames.Color3f)
    knob.Set((0.25, 0.5, 0.75))
    shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).ConnectToSource(knob)
    bind(add_mesh(stage, "/P", POINTS, FACES).GetPrim(), material)
    assert export(stage, tmp_path / "s")["material"]["reflectance"].tolist() == [[0.25, 0.5, 0.75]]


def test_a_preview_surface_s_own_default(tmp_path: Path) -> None:
    """UsdPreviewSurface: diffuseColor is 0.18 where nothing is authored."""
    stage = new_stage(tmp_path / "a.usda")
    bind(add_mesh(stage, "/P", POINTS, FACES).GetPrim(), add_material(stage, "M")[0])
    assert_allclose(export(stage, tmp_path / "s")["material"]["reflectance"], [[0.18] * 3])


def test_display_colour_and_grey(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    add_mesh(stage, "/Grey", POINTS, FACES)
    add_mesh(stage, "/Own", POINTS, FACES).CreateDisplayColorAttr([(0.25, 0, 0)])
    faces = add_mesh(stage, "/PerFace", *TWO_FACES).CreateDisplayColorPrimvar("uniform")
    faces.Set([(0, 1, 0), (0, 0, 1)])
    varying = add_mesh(stage, "/Varying", POINTS, FACES).CreateDisplayColorPrimvar("vertex")
    varying.Set([(0, 0, 0), (1, 0, 0), (0, 0, 0), (1, 0, 0)])
    add_mesh(stage, "/Bright", POINTS, FACES).CreateDisplayColorAttr([(2, 0, 0)])
    scene = export(stage, tmp_path / "s")
    shown = scene["material"]["reflectance"][scene["triangle"]["material"]][::2]
    assert shown.tolist() == [
        [0.5] * 3, [0.25, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0, 0], [1, 0, 0],
    ]  # fmt: skip
    assert "taken as grey 0.5: /Grey." in scene.notes
    assert "taken as its mean: /Varying." in scene.notes
    assert "outside 0 to 1 are clipped: /Bright." in scene.notes


def test_notes_on_materials(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    material, shader = add_material(stage, "Sign", (0, 0, 0))
    shader.CreateInput("emissiveColor", Sdf.ValueTypeNames.Color3f).Set((3, 3, 3))
    shader.CreateInput("opacity", Sdf.ValueTypeNames.Float).Set(0.5)
    bind(add_mesh(stage, "/P", POINTS, FACES).GetPrim(), material)
    foreign = UsdShade.Material.Define(stage, "/Looks/Foreign")
    bind(add_mesh(stage, "/Q", POINTS, FACES).GetPrim(), foreign)
    notes = export(stage, tmp_path / "s").notes
    assert "Emissive surfaces do not shine; give them windows or a RectLight: /Looks/Sign." in notes
    assert "not opaque are taken as opaque: /Looks/Sign." in notes
    assert "without a UsdPreviewSurface are replaced by displayColor: /Looks/Foreign." in notes


TEXTURE = np.array([[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [200, 100, 50]]], np.uint8)


def textured_square(tmp_path: Path, *, space: str = "auto", name: str = "st") -> Usd.Stage:
    """A square under a 2 x 2 texture; texture coordinates by face corner, indexed, beyond 1."""
    image = OpenImageIO.ImageBuf(OpenImageIO.ImageSpec(2, 2, 3, "uint8"))
    image.set_pixels(OpenImageIO.ROI(), TEXTURE)
    image.write(str(tmp_path / "t.png"))
    stage = new_stage(tmp_path / "a.usda")
    material, shader = add_material(stage, "M")
    texture = UsdShade.Shader.Define(stage, "/Looks/M/Texture")
    texture.CreateIdAttr("UsdUVTexture")
    texture.CreateInput("file", Sdf.ValueTypeNames.Asset).Set("./t.png")
    texture.CreateInput("sourceColorSpace", Sdf.ValueTypeNames.Token).Set(space)
    texture.CreateInput("scale", Sdf.ValueTypeNames.Float4).Set((0.5, 1, 0.25, 1))
    reader = UsdShade.Shader.Define(stage, "/Looks/M/Reader")
    reader.CreateIdAttr("UsdPrimvarReader_float2")
    reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set(name)
    texture.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(
        reader.ConnectableAPI(), "result"
    )
    shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).ConnectToSource(
        texture.ConnectableAPI(), "rgb"
    )
    mesh = add_mesh(stage, "/P", *TWO_FACES)
    bind(mesh.GetPrim(), material)
    st = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar(
        name, Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.faceVarying
    )
    st.Set([(0, 0), (3, 0), (3, 2), (0, 2), (9, 9)])
    st.SetIndices([0, 1, 2, 3, 4, 1, 2, 4])
    return stage


def test_a_texture(tmp_path: Path) -> None:
    stage = textured_square(tmp_path, name="map1")
    add_mesh(stage, "/Plain", POINTS, FACES)
    scene = export(stage, tmp_path / "s")
    material = scene["material"][scene["triangle"]["material"][0]]
    assert [material[name] for name in ("first_texel", "width", "height")] == [0, 2, 2]
    assert material["reflectance"].tolist() == [0.5, 1, 0.25]
    assert scene["texel"]["rgba"][:, :3].tolist() == [*TEXTURE[1].tolist(), *TEXTURE[0].tolist()]
    assert len(scene["texcoord"]) == len(scene["position"]) == 12  # 8 corners of one mesh, 4 plain
    vertex = scene["triangle"]["vertex"]
    positions, texcoords = scene["position"]["position"], scene["texcoord"]["texcoord"]
    pairs = {(*positions[v][:2].tolist(), *texcoords[v].tolist()) for v in vertex[:4].reshape(-1)}
    assert pairs == {
        (0, 0, 0, 0), (1, 0, 3, 0), (1, 1, 3, 2), (0, 1, 0, 2),
        (1, 0, 9, 9), (2, 0, 3, 0), (2, 1, 3, 2), (1, 1, 9, 9),
    }  # fmt: skip


def test_a_texture_in_a_package(tmp_path: Path) -> None:
    plain = export(textured_square(tmp_path), tmp_path / "s")
    package = tmp_path / "a.usdz"
    assert UsdUtils.CreateNewUsdzPackage(str(tmp_path / "a.usda"), str(package))
    export_stage(package, tmp_path / "t")
    assert Scene(tmp_path / "t").bytes == plain.bytes


def test_a_linear_texture_is_encoded(tmp_path: Path) -> None:
    scene = export(textured_square(tmp_path, space="raw"), tmp_path / "s")
    # IEC 61966-2-1: 200 / 255, 100 / 255 and 50 / 255, taken as linear, encode to these.
    assert scene["texel"]["rgba"][1, :3].tolist() == [229, 168, 122]


@pytest.mark.parametrize("broken", ["missing", "no image"])
def test_bad_textures_are_named(tmp_path: Path, broken: str) -> None:
    stage = textured_square(tmp_path)
    (tmp_path / "t.png").unlink()
    if broken == "no image":
        (tmp_path / "t.png").write_text("not an image")
    with pytest.raises(SceneError) as error:
        export(stage, tmp_path / "s")
    assert "/Looks/M/Texture" in str(error.value) and "t.png" in str(error.value)


def test_texture_coordinates_that_are_missing_or_short(tmp_path: Path) -> None:
    stage = textured_square(tmp_path)
    primvar = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/P")).GetPrimvar("st")
    primvar.SetIndices([0, 1, 2])
    with pytest.raises(SceneError, match=r"/P.primvars:st has 3 values, too few"):
        export(stage, tmp_path / "s")
    primvar.SetIndices([0, 1, 2, 3, 4, 1, 2, 7])
    with pytest.raises(SceneError, match=r"/P.primvars:st:indices must lie between 0 and 4"):
        export(stage, tmp_path / "s")
    stage.GetPrimAtPath("/P").RemoveProperty("primvars:st")
    stage.GetPrimAtPath("/P").RemoveProperty("primvars:st:indices")
    assert (
        "no primvars:st; the texture's corner is shown: /P." in export(stage, tmp_path / "s").notes
    )


def ground(stage: Usd.Stage, path: str, points: list) -> UsdGeom.Mesh:
    mesh = add_mesh(stage, path, points, FACES)
    mesh.GetPrim().ApplyAPI("NightcityGroundAPI")
    return mesh


def test_the_ground_is_a_plane(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    UsdGeom.Xform.Define(stage, "/A").AddTranslateOp().Set((0, 0, -2.5))
    bind(ground(stage, "/A/G", POINTS).GetPrim(), add_material(stage, "M", (0.25, 0, 0))[0])
    scene = export(stage, tmp_path / "s")
    assert scene.manifest["ground"] == {"height": -2.5, "material": 0}
    assert scene["material"]["reflectance"].tolist() == [[0.25, 0, 0]]
    assert len(scene["triangle"]) == 0
    UsdGeom.Imageable(stage.GetPrimAtPath("/A")).MakeInvisible()
    add_mesh(stage, "/M", POINTS, FACES)
    assert export(stage, tmp_path / "t").manifest["ground"] is None


def test_a_textured_ground_is_its_mean(tmp_path: Path) -> None:
    stage = textured_square(tmp_path)
    stage.GetPrimAtPath("/P").ApplyAPI("NightcityGroundAPI")
    scene = export(stage, tmp_path / "s")
    material = scene["material"][scene.manifest["ground"]["material"]]
    encoded = TEXTURE.reshape(-1, 3) / 255.0
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    assert_allclose(material["reflectance"], linear.mean(axis=0) * (0.5, 1, 0.25), rtol=1e-6)
    assert material["width"] == 0
    assert "A textured ground is taken as its texture's mean: /P." in scene.notes


def test_bad_grounds_are_named(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    ground(stage, "/Slope", [*POINTS[:3], (0, 1, 0.1)])
    with pytest.raises(SceneError, match=r"/Slope: .* from 0 to 0.1 m"):
        export(stage, tmp_path / "s")
    ground(stage, "/Flat", POINTS)
    with pytest.raises(SceneError, match="/Slope and /Flat: a scene has one ground"):
        export(stage, tmp_path / "s")
