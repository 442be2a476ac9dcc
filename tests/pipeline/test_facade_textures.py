# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Built-in textures tile and are bright; image files arrive as they are or are refused."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio  # noqa: N813
import pytest

from nightcity.city.textures import BUILT_IN, facade_textures
from nightcity.errors import UsageError


def write(path, pixels):
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], "uint8")
    image = oiio.ImageOutput.create(str(path))
    assert image.open(str(path), spec) and image.write_image(pixels)
    image.close()
    return str(path)


@pytest.mark.parametrize("name", [name for name in BUILT_IN if name != "plain"])
def test_built_in_textures(name):
    (texture,) = facade_textures((name,), 10.0)
    texels = texture.texels
    assert texels.shape == (256, 256, 3) and texels.dtype == np.uint8
    assert texels.std() > 2 and texels.max() > 180  # it shows something, and is no dark wall
    assert np.array_equal(texels, facade_textures((name,), 10.0)[0].texels)
    # Across the seam no larger step than inside.
    signed = texels.astype(int)
    for axis in (0, 1):
        inner = abs(np.diff(signed, axis=axis)).max()
        seam = abs(np.take(signed, 0, axis) - np.take(signed, -1, axis)).max()
        assert seam <= inner


def test_plain_has_no_texels():
    assert facade_textures(("plain",), 10.0)[0].texels is None


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_image_file(tmp_path, channels):
    pixels = np.random.default_rng(1).integers(0, 256, (4, 8, channels)).astype(np.uint8)
    if channels in (2, 4):
        pixels[..., -1] = 255  # alpha
    (texture,) = facade_textures((write(tmp_path / "wall.png", pixels),), 6.0)
    expected = pixels[..., :3] if channels >= 3 else np.repeat(pixels[..., :1], 3, axis=2)
    assert np.array_equal(texture.texels, expected)
    assert texture.size == (6.0, 3.0)


def test_names_are_unique():
    names = [t.name for t in facade_textures(("brick", "plain", "glass", "concrete"), 1.0)]
    assert len(set(names)) == 4


def test_refuses_a_missing_file(tmp_path):
    with pytest.raises(UsageError, match=r"facade_textures: .*none.png: no such file"):
        facade_textures((str(tmp_path / "none.png"),), 1.0)


@pytest.mark.parametrize("content", [b"", b"no image", b"\x89PNG\r\n\x1a\n" + b"\0" * 40])
def test_refuses_what_is_no_image(tmp_path, content):
    path = tmp_path / "wall.png"
    path.write_bytes(content)
    with pytest.raises(UsageError, match=r"facade_textures: .*wall.png"):
        facade_textures((str(path),), 1.0)


def test_refuses_a_truncated_image(tmp_path):
    pixels = np.random.default_rng(1).integers(0, 256, (64, 64, 3)).astype(np.uint8)
    path = tmp_path / "wall.png"
    write(path, pixels)
    path.write_bytes(path.read_bytes()[:3000])
    with pytest.raises(UsageError, match=r"facade_textures: .*wall.png"):
        facade_textures((str(path),), 1.0)


def test_refuses_a_huge_image(tmp_path):
    path = write(tmp_path / "wall.png", np.zeros((1, 9000, 3), np.uint8))
    with pytest.raises(UsageError, match="larger than 8192"):
        facade_textures((path,), 1.0)
