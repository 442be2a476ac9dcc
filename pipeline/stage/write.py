# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a city as a USD stage: a small root layer over one layer for each kind of thing."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path

from pxr import Sdf, Tf

from nightcity import schemas
from nightcity.city.model import City
from nightcity.errors import NightcityError, UsageError
from nightcity.stage.cameras import write_cameras
from nightcity.stage.check_city import check_city
from nightcity.stage.geometry import write_geometry
from nightcity.stage.layout import new_layer
from nightcity.stage.materials import write_texture
from nightcity.stage.media import write_media
from nightcity.stage.root import write_root
from nightcity.stage.windows import write_windows

# The sublayers, strongest first: what a layer is called, its format, and who writes it.
Step = Callable[[City, Sdf.Layer, str], None]
STEPS: tuple[tuple[str, str, Step], ...] = (
    ("cameras", "usda", lambda city, layer, textures: write_cameras(city, layer)),
    ("media", "usdc", lambda city, layer, textures: write_media(city, layer)),
    ("windows", "usdc", lambda city, layer, textures: write_windows(city, layer)),
    ("geometry", "usdc", write_geometry),
)


def write_stage(city: City, path: Path) -> list[Path]:
    """Write the city as the stage ``path`` (.usda) and return all files, the root layer first.

    Beside it come STEM.cameras.usda, STEM.media.usdc, STEM.windows.usdc, STEM.geometry.usdc and,
    where materials have textures, STEM.textures/NAME.png. Everything is written in a folder of
    its own first: if anything fails, no file of that name is touched. Files that are there are
    replaced. The same city gives the same bytes.

    Raises SceneError if the city is not sound, UsageError for a path that cannot be a stage, and
    NightcityError if the disk refuses.
    """
    path = Path(path)
    if path.suffix != ".usda":
        raise UsageError(f"{path}: the root layer is text, so its name must end in .usda")
    schemas.register()
    check_city(city)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=f".{path.stem}.", dir=path.parent) as folder:
            names = _write_files(city, path.name, Path(folder))
            written = _move(names, Path(folder), path.parent)
    except OSError as error:
        raise NightcityError(f"cannot write {path}: {error}") from error
    _reload(written)
    return written


def _write_files(city: City, root_name: str, folder: Path) -> list[str]:
    """Write all files into ``folder`` and return their names, the root layer first."""
    stem = Path(root_name).stem
    textures = f"{stem}.textures"
    sublayers = []
    for thing, extension, write in STEPS:
        layer = new_layer(extension)
        with Sdf.ChangeBlock():
            write(city, layer, textures)
        sublayers.append(f"{stem}.{thing}.{extension}")
        _save(layer, folder / sublayers[-1])
    root = new_layer("usda")
    with Sdf.ChangeBlock():
        write_root(city, root, sublayers)
    _save(root, folder / root_name)
    return [root_name, *sublayers, *_write_textures(city, folder, textures)]


def _write_textures(city: City, folder: Path, name: str) -> list[str]:
    textured = [material for material in city.materials if material.texture is not None]
    if textured:
        (folder / name).mkdir()
    return [
        str(write_texture(material, folder / name).relative_to(folder)) for material in textured
    ]


def _save(layer: Sdf.Layer, path: Path) -> None:
    try:
        written = layer.Export(str(path))
    except Tf.ErrorException as error:
        raise OSError(f"{path.name}: {error}") from error
    if not written:
        raise OSError(f"{path.name}: USD could not write it")


def _move(names: list[str], source: Path, target: Path) -> list[Path]:
    """Move the finished files to their place, the root layer last."""
    for name in reversed(names):
        (target / name).parent.mkdir(exist_ok=True)
        os.replace(source / name, target / name)
    return [target / name for name in names]


def _reload(files: list[Path]) -> None:
    """Let stages that this process has open see the new files."""
    for path in files:
        layer = Sdf.Layer.Find(str(path)) if path.suffix != ".png" else None
        if layer is not None:
            layer.Reload(force=True)
