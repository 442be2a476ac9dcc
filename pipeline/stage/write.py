# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a city as a USD stage: a small root layer over one layer for each kind of thing."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from pxr import Sdf, Tf

from nightcity import schemas
from nightcity.city.districts import district_cities, districts, is_large
from nightcity.city.model import City
from nightcity.errors import NightcityError, UsageError
from nightcity.parallel import in_order
from nightcity.stage import layout
from nightcity.stage.cameras import write_cameras
from nightcity.stage.check_city import check_parts, check_whole
from nightcity.stage.geometry import write_geometry, write_ground
from nightcity.stage.layout import new_layer
from nightcity.stage.materials import write_texture
from nightcity.stage.media import write_media
from nightcity.stage.root import write_district, write_districts, write_root
from nightcity.stage.windows import write_windows

# Sublayers, strongest first: what a layer is called, its format, and who writes it.
Step = Callable[[City, Sdf.Layer, str], None]
Steps = tuple[tuple[str, str, Step], ...]
CAMERAS: Steps = (("cameras", "usda", lambda city, layer, textures: write_cameras(city, layer)),)
BUILT: Steps = (
    ("media", "usdc", lambda city, layer, textures: write_media(city, layer)),
    ("windows", "usdc", lambda city, layer, textures: write_windows(city, layer)),
    ("geometry", "usdc", write_geometry),
)
GROUND: Steps = (("ground", "usdc", write_ground),)


@dataclass(frozen=True)
class _District:
    """What a process needs to write one district: its file in ``folder``, the city's textures
    relative to it, and its part of the city."""

    folder: Path
    name: str
    textures: str
    city: City


def write_stage(city: City, path: Path) -> list[Path]:
    """Write the city as the stage ``path`` (.usda) and return all files, the root layer first.

    Beside it come STEM.cameras.usda, STEM.media.usdc, STEM.windows.usdc, STEM.geometry.usdc and,
    where materials have textures, STEM.textures/NAME.png. A large city (city/districts.py) has
    STEM.ground.usdc, STEM.districts.usda and a folder STEM.districts instead of the media, windows
    and geometry, the districts written by several processes. Everything is written in a folder of
    its own first: if anything fails, no file of that name is touched. Files that are there are
    replaced. The same city gives the same bytes.

    Raises SceneError if the city is not sound, UsageError for a path that cannot be a stage, and
    NightcityError if the disk refuses.
    """
    path = Path(path)
    if path.suffix != ".usda":
        raise UsageError(f"{path}: the root layer is text, so its name must end in .usda")
    schemas.register()
    check_whole(city)
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
    if is_large(city):
        sublayers = _write_layers(city, stem, textures, folder, CAMERAS + GROUND)
        files = _write_districts(city, stem, folder)
        sublayers.insert(1, f"{stem}.districts.usda")
        roots = [name for name in files if name.endswith(".usda")]
        _save(_made("usda", lambda layer: write_districts(layer, roots)), folder / sublayers[1])
    else:
        check_parts(city)
        sublayers, files = _write_layers(city, stem, textures, folder, CAMERAS + BUILT), []
    root = _made("usda", lambda layer: write_root(city, layer, sublayers))
    _save(root, folder / root_name)
    return [root_name, *sublayers, *files, *_write_textures(city, folder, textures)]


def _write_layers(city: City, stem: str, textures: str, folder: Path, steps: Steps) -> list[str]:
    names = []
    for thing, extension, write in steps:
        layer = _made(extension, lambda layer, write=write: write(city, layer, textures))
        names.append(f"{stem}.{thing}.{extension}")
        _save(layer, folder / names[-1])
    return names


def _made(extension: str, write: Callable[[Sdf.Layer], None]) -> Sdf.Layer:
    layer = new_layer(extension)
    with Sdf.ChangeBlock():
        write(layer)
    return layer


def _write_districts(city: City, stem: str, folder: Path) -> list[str]:
    """Write every district below ``folder``; the names of all files, by district."""
    holder = f"{stem}.districts"
    (folder / holder).mkdir()
    parts = districts(city)
    work = (
        _District(folder / holder, layout.district_name(index), f"../{stem}.textures", part)
        for index, part in enumerate(district_cities(city, parts))
    )
    written = in_order(_write_district, work, len(parts), "writing districts")
    return [f"{holder}/{name}" for names in written for name in names]


def _write_district(district: _District) -> list[str]:
    """Names of the files, the district's root layer first."""
    schemas.register()
    check_parts(district.city)
    sublayers = _write_layers(
        district.city, district.name, district.textures, district.folder, BUILT
    )
    root_name = f"{district.name}.usda"
    _save(
        _made("usda", lambda layer: write_district(layer, sublayers)), district.folder / root_name
    )
    return [root_name, *sublayers]


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
        first = str(error).strip().splitlines()[0]  # a line for each block that was not written
        raise OSError(f"{path.name}: {first.strip()}") from error
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
