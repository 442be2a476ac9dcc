# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Tiles: rendered apart and stitched, a frame is the frame to the bit."""

from __future__ import annotations

import resource
import signal
import subprocess
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest
from farm_job import ENVIRONMENT, OPTIONS, call, make_shot

SIZE = ("--size", "64x37", "--camera", "street")
SIZE += ("--method", "march", "--subdivisions", "3")


def read(path: Path) -> tuple[np.ndarray, dict[str, str], list[str]]:
    image = OpenImageIO.ImageInput.open(str(path))
    spec = image.spec()
    pixels = image.read_image("float")
    image.close()
    assert (spec.x, spec.y, spec.full_height) == (0, 0, spec.height)
    own = {"ImageDescription", "Software", "Exif:ImageHistory", "openexr:chunkCount"}
    attributes = {a.name: str(a.value) for a in spec.extra_attribs if a.name not in own}
    return pixels, attributes, list(spec.channelnames)


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("scene")
    call("nightcity", "generate", "--preset", "paper-1x1", "-o", folder / "city.usda")
    call("nightcity", "export", folder / "city.usda", "-o", folder / "scene")
    call("nightcity-render", folder / "scene", *SIZE, "-o", folder / "whole.exr")
    return folder


def tiles(scene: Path, frame: Path, count: int) -> list[Path]:
    for number in range(1, count + 1):
        call(
            *("nightcity-render", scene / "scene", *SIZE, "-o", frame),
            *("--tile", f"{number}/{count}"),
        )
    return sorted(frame.parent.glob(f"{frame.stem}.*of*.exr"))


def test_stitched_tiles_are_the_frame(scene: Path, tmp_path: Path) -> None:
    frame = tmp_path / "whole.exr"
    assert len(tiles(scene, frame, 3)) == 3
    assert "wrote" in call("nightcity", "stitch", frame).stdout
    pixels, attributes, channels = read(frame)
    expected, expected_attributes, expected_channels = read(scene / "whole.exr")
    assert channels == expected_channels
    assert pixels.tobytes() == expected.tobytes()
    assert attributes == expected_attributes
    # For the renderer it is the frame, which it does not render again.
    options = (*SIZE, "-o", frame, "--skip-existing")
    assert "kept" in call("nightcity-render", scene / "scene", *options).stdout
    first = frame.read_bytes()
    call("nightcity", "stitch", frame, "--remove-tiles")
    assert [path.name for path in tmp_path.iterdir()] == ["whole.exr"]
    assert frame.read_bytes() == first
    assert "kept" in call("nightcity", "stitch", frame).stdout


def test_wrong_tiles_are_named_and_nothing_is_written(scene: Path, tmp_path: Path) -> None:
    frame = tmp_path / "whole.exr"
    assert "no tiles" in call("nightcity", "stitch", frame, code=3).stderr
    top, bottom = tiles(scene, frame, 2)
    whole = bottom.read_bytes()
    bottom.unlink()
    assert "missing: 2" in call("nightcity", "stitch", frame, code=3).stderr
    bottom.write_bytes(whole[: len(whole) * 2 // 3])
    assert bottom.name in call("nightcity", "stitch", frame, code=3).stderr
    options = (*SIZE, "-o", frame, "--tile", "2/2", "--seed", "9")
    call("nightcity-render", scene / "scene", *options)
    assert "other settings" in call("nightcity", "stitch", frame, code=3).stderr
    bottom.write_bytes(top.read_bytes())
    assert "does not continue" in call("nightcity", "stitch", frame, code=3).stderr
    assert sorted(tmp_path.iterdir()) == [top, bottom]


def test_a_job_in_tiles(scene: Path, tmp_path: Path) -> None:
    shot = make_shot(tmp_path / "shot", scene / "city.usda", "--frames", "1", "--tiles", "2")
    shot.run("--workers", "1")
    assert set(shot.files()) == {
        *("frame.0001.exr", "contact-sheet.png", "movie.mp4", "scene/scene.json"),
        "scene/scene.bin",
    }


def test_a_full_disk_is_an_error_and_leaves_nothing(scene: Path, tmp_path: Path) -> None:
    def limit() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
        resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))

    done = subprocess.run(
        ["nightcity-render", scene / "scene", *OPTIONS, "-o", tmp_path / "a.exr"],
        env=ENVIRONMENT,
        preexec_fn=limit,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert f"{tmp_path}/a.exr: cannot be written" in done.stderr
    assert list(tmp_path.iterdir()) == []
