# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The whole chain once as a user would run it: commands only, from parameters to pictures."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest
from conftest import ROOT, Command
from pxr import Gf, Usd, UsdGeom

import nightcity.schemas

nightcity.schemas.register()

SIZE = "192x106"
CAMERA = ("--camera", "overview75", "--size", SIZE, "--tolerance", "0.1")


def read_image(path: Path) -> tuple[dict[str, np.ndarray], OpenImageIO.ImageSpec]:
    image = OpenImageIO.ImageInput.open(str(path))
    assert image, OpenImageIO.geterror()
    spec = image.spec()
    pixels = image.read_image("float")
    image.close()
    return {name: pixels[..., i] for i, name in enumerate(spec.channelnames)}, spec


def glow(path: Path) -> np.ndarray:
    channels = read_image(path)[0]
    return np.stack([channels[f"glow.{c}"] for c in "RGB"], axis=-1)


@pytest.fixture(scope="module")
def stage(nightcity: Command, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("city") / "city.usda"
    nightcity("generate", "--preset", "paper-2x2", "-o", path)
    return path


@pytest.fixture(scope="module")
def picture(nightcity: Command, stage: Path) -> Path:
    path = stage.with_name("frame.exr")
    nightcity("render", stage, *CAMERA, "-o", path, "--stats", path.with_suffix(".json"))
    return path


def test_generated_stage_is_valid(nightcity: Command, stage: Path) -> None:
    assert "0 errors, 0 warnings" in nightcity("validate", stage).stdout


def test_picture_shows_windows_and_glow(picture: Path) -> None:
    channels, spec = read_image(picture)
    assert (spec.width, spec.height) == (192, 106)
    assert all(np.isfinite(values).all() for values in channels.values())
    transmittance = channels["transmittance.Y"]
    # A ray onto a roof may meet micrometres of haze, with next to no glow or none at all.
    haze = transmittance < 1 - 1e-5
    assert 0.1 < haze.mean() < 0.9
    assert (channels["glow.R"][haze] > 0).all()
    assert (channels["glow.R"][~haze] < 1e-5 * channels["glow.R"].max()).all()
    # A lit window seen directly emits P / (pi A) = 50 / (pi 1.2 1.5) = 8.84 W m^-2 sr^-1.
    assert 8 < (channels["R"] / channels["transmittance.Y"]).max() < 9.2
    for c in "RGB":
        np.testing.assert_allclose(
            channels[c], channels[f"surface.{c}"] + channels[f"glow.{c}"], rtol=1e-6
        )


def test_metadata_names_the_scene_and_no_place(picture: Path, stage: Path) -> None:
    attributes = {a.name: str(a.value) for a in read_image(picture)[1].extra_attribs}
    text = json.dumps(attributes)
    assert str(stage.parent) not in text
    assert not any("date" in name.lower() or "host" in name.lower() for name in attributes)
    assert any("hash" in name.lower() for name in attributes)


def test_statistics(picture: Path) -> None:
    statistics = json.loads(picture.with_suffix(".json").read_text())
    counts = statistics["counts"]
    assert [counts[k] for k in ("buildings", "windows", "media_boxes", "triangles")] == [
        4,
        320,
        21,
        940,
    ]
    assert set(statistics) >= {"device", "settings", "counts", "timing"}
    assert set(statistics["timing"]) >= {"first_frame_ms", "steady_frame_ms", "bake_ms", "passes"}


def test_same_seed_same_bytes(nightcity: Command, stage: Path, tmp_path: Path) -> None:
    again = tmp_path / stage.name
    nightcity("generate", "--preset", "paper-2x2", "-o", again)
    layers = sorted(p.name for p in stage.parent.glob("city*.usd*"))
    assert layers == sorted(p.name for p in tmp_path.glob("city*.usd*"))
    for name in layers:
        assert (tmp_path / name).read_bytes() == (stage.parent / name).read_bytes(), name


def test_same_scene_same_image_bytes(
    nightcity: Command, stage: Path, picture: Path, tmp_path: Path
) -> None:
    again = tmp_path / "again.exr"
    nightcity("render", stage, *CAMERA, "-o", again)
    assert again.read_bytes() == picture.read_bytes()


def override(stage: Path, folder: Path, change: Callable[[Usd.Stage], None]) -> Path:
    """An artist's layer over the stage, with opinions of its own."""
    path = folder / "artist.usda"
    layer = Usd.Stage.CreateNew(str(path))
    layer.GetRootLayer().subLayerPaths.append(str(stage))
    UsdGeom.SetStageUpAxis(layer, UsdGeom.Tokens.z)
    UsdGeom.SetStageMetersPerUnit(layer, 1)
    layer.SetDefaultPrim(layer.GetPrimAtPath("/City"))
    change(layer)
    layer.Save()
    return path


def with_api(stage: Usd.Stage, api: str) -> list[Usd.Prim]:
    return [prim for prim in stage.Traverse() if prim.HasAPI(api)]


def render_override(nightcity: Command, artist: Path, *options: str) -> np.ndarray:
    picture = artist.with_suffix(".exr")
    nightcity("render", artist, *(options or CAMERA), "-o", picture)
    return glow(picture)


def test_override_windows_off(
    nightcity: Command, stage: Path, picture: Path, tmp_path: Path
) -> None:
    def switch_off(layer: Usd.Stage) -> None:
        for prim in with_api(layer, "NightcityWindowsAPI"):
            prim.GetAttribute("nightcity:lightOn").Set([False])

    assert render_override(nightcity, override(stage, tmp_path, switch_off)).max() == 0
    assert glow(picture).max() > 0


def test_override_extinction(
    nightcity: Command, stage: Path, picture: Path, tmp_path: Path
) -> None:
    def clear_the_air(layer: Usd.Stage) -> None:
        for prim in with_api(layer, "NightcityMediaAPI"):
            prim.GetAttribute("nightcity:extinction").Set(0.0001)

    thin = render_override(nightcity, override(stage, tmp_path, clear_the_air))
    # A hundredth of the haze: nearly a hundredth of the glow.
    assert 0.01 < thin.mean() / glow(picture).mean() < 0.02


def test_override_moves_a_building(
    nightcity: Command, stage: Path, picture: Path, tmp_path: Path
) -> None:
    def lift(layer: Usd.Stage) -> None:
        building = with_api(layer, "NightcityBuildingAPI")[0]
        building.GetAttribute("xformOp:translate").Set(Gf.Vec3d(0, 0, 500))

    without = render_override(nightcity, override(stage, tmp_path, lift))
    assert without.mean() < 0.9 * glow(picture).mean()


def test_override_adds_a_camera(nightcity: Command, stage: Path, tmp_path: Path) -> None:
    def add(layer: Usd.Stage) -> None:
        camera = UsdGeom.Camera.Define(layer, "/City/Cameras/mine")
        camera.AddTranslateOp().Set(Gf.Vec3d(0, -60, 10))
        camera.AddRotateXYZOp().Set(Gf.Vec3f(90, 0, 0))

    artist = override(stage, tmp_path, add)
    assert render_override(nightcity, artist, "--camera", "mine", "--size", SIZE).max() > 0


def test_town(nightcity: Command, tmp_path: Path) -> None:
    town = tmp_path / "town.usda"
    nightcity("import", ROOT / "tests/data/delft-excerpt.city.json", "-o", town)
    nightcity("validate", town)
    picture = tmp_path / "town.png"
    nightcity("render", town, "--size", SIZE, "--tolerance", "0.1", "-o", picture)
    values = read_image(picture)[0]["R"]
    assert values.std() > 0.02


@pytest.mark.parametrize(
    ("options", "code", "word"),
    [
        (("--camera", "nowhere"), 2, "overview75"),
        (("--size", "0x10"), 2, "size"),
        (("--subdivisions", "0"), 2, "subdivisions"),
        (("--method", "guess"), 2, "march"),
        (("--model", "full", "--method", "gauss"), 2, "--method field and path"),
        (("--model", "best"), 2, "paper"),
        (("--tolerence", "0.1"), 2, "did you mean --tolerance?"),
    ],
)
def test_wrong_options(
    nightcity: Command, stage: Path, tmp_path: Path, options: tuple, code: int, word: str
) -> None:
    done = nightcity("render", stage, *options, "-o", tmp_path / "x.exr", code=code)
    assert word in done.stderr
    assert not list(tmp_path.iterdir())


def test_missing_stage(nightcity: Command, tmp_path: Path) -> None:
    done = nightcity("render", tmp_path / "no.usda", "-o", tmp_path / "x.exr", code=3)
    assert "no.usda" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("command", "word"),
    [
        (("generate", "--griid", "3x3", "-o", "city.usda"), "did you mean --grid?"),
        (("bench", "growth", "--methds", "field", "-o", "out"), "did you mean --methods?"),
    ],
)
def test_unknown_options_name_the_nearest(nightcity: Command, command: tuple, word: str) -> None:
    assert word in nightcity(*command, code=2).stderr


def test_unknown_parameter_names_the_nearest(nightcity: Command, tmp_path: Path) -> None:
    config = tmp_path / "city.toml"
    config.write_text("extincton = 0.02\n")
    done = nightcity("generate", "--config", config, "-o", tmp_path / "c.usda", code=2)
    assert "extinction" in done.stderr
    assert str(config) in done.stderr
