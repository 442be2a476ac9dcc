# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Contact sheet and movie show what the frames show; names and frames are the renderer's."""

from __future__ import annotations

import json
from pathlib import Path

import av
import numpy as np
import OpenImageIO
import pytest
from farm_job import OPTIONS, call

from nightcity.display import read_display
from nightcity.errors import SceneError, UsageError
from nightcity.frames import frame_file, frame_files, parse_frames
from nightcity.preview import contact_sheet, movie

COLOURS = [(0.9, 0.1, 0.1), (0.1, 0.8, 0.2), (0.2, 0.3, 0.9), (0.5, 0.5, 0.5)]


def write(path: Path, pixels: np.ndarray) -> Path:
    height, width, _ = pixels.shape
    out = OpenImageIO.ImageOutput.create(str(path))
    kind = "float" if path.suffix == ".exr" else "uint8"
    assert out.open(str(path), OpenImageIO.ImageSpec(width, height, 3, kind))
    assert out.write_image(pixels.astype(np.float32))
    out.close()
    return path


@pytest.fixture
def frames(tmp_path: Path) -> list[Path]:
    """One plain colour a frame, 33 x 21."""
    return [
        write(tmp_path / f"f.{i + 1}.png", np.full((21, 33, 3), colour))
        for i, colour in enumerate(COLOURS)
    ]


def test_tone_map_is_the_renderers(tmp_path: Path) -> None:
    call("nightcity", "generate", "--preset", "paper-1x1", "-o", tmp_path / "city.usda")
    for name in ("a.exr", "a.png"):
        call("nightcity", "render", tmp_path / "city.usda", *OPTIONS, "-o", tmp_path / name)
    shown, stored = (read_display(tmp_path / name, 2) for name in ("a.exr", "a.png"))
    assert stored.max() > 0.9
    assert np.abs(shown - stored).max() <= 0.51 / 255


def test_sheet_shows_every_frame_in_order(frames: list[Path], tmp_path: Path) -> None:
    contact_sheet(frames, tmp_path / "sheet.png", 2)
    pixels = read_display(tmp_path / "sheet.png", 2)
    assert pixels.shape == (4 + 2 * 25, 4 + 2 * 37, 3)
    for i, colour in enumerate(COLOURS):
        y, x = 4 + i // 2 * 25 + 10, 4 + i % 2 * 37 + 16
        np.testing.assert_allclose(pixels[y, x], colour, atol=1 / 255)


def test_sheet_of_many_frames_chooses(frames: list[Path], tmp_path: Path) -> None:
    line = contact_sheet(frames * 60, tmp_path / "sheet.png", 2)
    assert "80 of 240 frames" in line


def test_movie_shows_every_frame_in_order(frames: list[Path], tmp_path: Path) -> None:
    (tmp_path / "scene.json").write_text(json.dumps({"frames": {"per_second": 25}}))
    for name in ("a.mp4", "b.mp4"):
        movie(frames, tmp_path / name, tmp_path, 2)
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()
    with av.open(str(tmp_path / "a.mp4")) as container:
        stream = container.streams.video[0]
        assert (stream.average_rate, stream.width, stream.height) == (25, 32, 20)
        shown = [picture.to_ndarray(format="rgb24") for picture in container.decode(video=0)]
    assert len(shown) == len(COLOURS)
    for picture, colour in zip(shown, COLOURS, strict=True):
        np.testing.assert_allclose(picture[10, 16] / 255, colour, atol=4 / 255)


def test_frames_that_are_wrong_are_named(frames: list[Path], tmp_path: Path) -> None:
    (tmp_path / "scene.json").write_text(json.dumps({"frames": {"per_second": 25}}))
    frames[1].write_bytes(frames[1].read_bytes()[:60])
    for make in (
        lambda: contact_sheet(frames, tmp_path / "sheet.png", 2),
        lambda: movie(frames, tmp_path / "a.mp4", tmp_path, 2),
    ):
        with pytest.raises(SceneError, match=r"f\.2\.png"):
            make()
    write(frames[1], np.zeros((5, 5, 3)))
    with pytest.raises(SceneError, match=r"f\.2\.png: is of another size"):
        movie(frames, tmp_path / "a.mp4", tmp_path, 2)
    with pytest.raises(SceneError, match="frame rate"):
        movie(frames, tmp_path / "a.mp4", tmp_path / "none", 2)
    assert not [p for p in tmp_path.iterdir() if p.suffix == ".mp4" or ".part" in p.name]


def test_frames_are_read_as_the_renderer_does() -> None:
    assert parse_frames("1-10x2,20") == parse_frames("20,1-10:2") == [1, 3, 5, 7, 9, 20]
    assert parse_frames("-3--1") == [-3, -2, -1]
    for text in ("", ",", "1,", "5-1", "1-5x0", "a", "1-2-3", "1-2000000000"):
        with pytest.raises(UsageError):
            parse_frames(text)
    names = {"a.####.exr": "a.0007.exr", "a.%03d.exr": "a.007.exr", "a.%d.exr": "a.7.exr"}
    for pattern, name in names.items():
        assert frame_file(Path("out", pattern), 7) == Path("out", name)
    assert frame_file(Path("a.####.exr"), -7) == Path("a.-007.exr")
    with pytest.raises(UsageError, match="####"):
        frame_files(Path("a.exr"), "1-2")
