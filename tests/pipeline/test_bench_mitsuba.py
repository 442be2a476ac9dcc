# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What Mitsuba is given of a scene, and the comparison of means. No test runs Mitsuba."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from conftest import Command

from nightcity.bench.independent import compare_passes
from nightcity.bench.judge import View
from nightcity.bench.mitsuba_environment import MitsubaEnvironment
from nightcity.bench.peer_scene import pixel_rays, write_peer_scene
from nightcity.bench.scenes import open_scene
from nightcity.errors import SceneError, UsageError
from nightcity.export.read import read_scene

SIZE = "96x54"


@pytest.fixture
def view(tmp_path: Path) -> View:
    return View(open_scene("paper-1x1", tmp_path), "overview75", SIZE)


def test_the_city_as_mitsuba_takes_it(view: View, tmp_path: Path) -> None:
    write_peer_scene(view, np.array([[48, 27]]), tmp_path / "scene.npz")
    data = np.load(tmp_path / "scene.npz")
    np.testing.assert_allclose([data["lo"], data["hi"]], [[-15, -15, 0], [15, 15, 30]])
    assert (float(data["extinction"]), float(data["albedo"])) == pytest.approx((0.01, 0.9))
    assert len(data["faces"]) == 12
    # 80 panes of 1.2 x 1.5 m send 50 W each: P / (pi A).
    np.testing.assert_allclose(data["radiance"], np.full(80, 50 / (np.pi * 1.8)), rtol=1e-6)
    corners = data["corners"]
    assert corners.shape == (80, 4, 3)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 1])
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.8, rtol=1e-6)
    # The building stands about the z axis, so that outward is away from it.
    assert np.all(np.sum((normals * corners.mean(axis=1))[:, :2], axis=1) > 0)


def test_rays_by_hand(view: View) -> None:
    scene = read_scene(view.scene.folder)
    camera = scene.camera("overview75")
    origins, directions = pixel_rays(scene, view, np.array([[0, 0], [95, 53], [48, 27]]))
    np.testing.assert_array_equal(origins[0], camera["position"])
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1)
    up, forward = camera["up"].astype(float), camera["forward"].astype(float)
    # Opposite corners mirror each other about the line of sight; row 0 is the upper one.
    np.testing.assert_allclose(directions[0] @ up, -(directions[1] @ up))
    assert directions[0] @ up > 0
    # The top of the frame is tan_half_fov above the axis, the first row's centre half a pixel less.
    slope = (directions[0] @ up) / (directions[0] @ forward)
    assert slope == pytest.approx(float(camera["tan_half_fov"]) * 53 / 54)


def test_two_hazes_are_refused(tmp_path: Path) -> None:
    view = View(open_scene("mixed-6x6", tmp_path), "overview75", SIZE)
    with pytest.raises(SceneError, match="mixed-6x6: boxes of haze differ in extinction"):
        write_peer_scene(view, np.array([[48, 27]]), tmp_path / "scene.npz")


def test_haze_that_fills_no_box_is_refused(tmp_path: Path) -> None:
    scene = open_scene("paper-1x1", tmp_path, {"haze_layer_thickness": 0.0})
    bytes_of_scene = bytearray((scene.folder / "scene.bin").read_bytes())
    boxes = read_scene(scene.folder).manifest["arrays"]["media_box"]
    # The first box keeps its place and loses a third of its height.
    height = np.frombuffer(bytes_of_scene, "<f4", 1, boxes["offset"] + 24)
    bytes_of_scene[boxes["offset"] + 24 : boxes["offset"] + 28] = (height * 2 / 3).tobytes()
    (scene.folder / "scene.bin").write_bytes(bytes_of_scene)
    with pytest.raises(SceneError, match="do not fill one box"):
        write_peer_scene(
            View(scene, "overview75", SIZE), np.array([[48, 27]]), tmp_path / "scene.npz"
        )


def test_means_by_hand() -> None:
    # Means of the passes 1.1, 0.9, 1.2, 1.0 of the truth's 2: ratio 1.05, spread 0.1291.
    passes = np.array([[2.2, 2.2], [1.8, 1.8], [2.0, 2.8], [2.0, 2.0]])
    result = compare_passes(passes, np.array([1.0, 3.0]))
    assert result.ratio == pytest.approx(1.05)
    assert result.error == pytest.approx(np.std([1.1, 0.9, 1.2, 1.0], ddof=1) / 2)
    assert result.agrees
    assert not compare_passes(1.5 * passes, np.array([1.0, 3.0])).agrees


def test_wrong_input_is_named(nightcity: Command, tmp_path: Path) -> None:
    done = nightcity("bench", "mitsuba", "--environment", tmp_path / "nothing", code=2)
    assert "nothing: holds no Mitsuba with its LLVM; add --install" in done.stderr
    assert "--passes" in nightcity("bench", "mitsuba", "--passes", "2", code=2).stderr


def test_install_replaces_nothing_but_an_environment(tmp_path: Path) -> None:
    (tmp_path / "kept.txt").write_text("mine")
    with pytest.raises(UsageError, match="is there already and no Python environment"):
        MitsubaEnvironment(tmp_path).install()
    assert (tmp_path / "kept.txt").is_file()


def test_what_is_no_scene_is_refused(tmp_path: Path) -> None:
    (tmp_path / "scene.json").write_text("{}")
    with pytest.raises(SceneError, match="cannot be read as a flat scene"):
        read_scene(tmp_path)
