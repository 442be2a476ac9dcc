# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The scenes that a measurement runs on: presets, stages, flat scenes and CityJSON towns."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import xxhash

from nightcity.city.generate import generate
from nightcity.city.import_town import import_town
from nightcity.city.model import City
from nightcity.city.parameters import load_parameters, preset_names
from nightcity.city.town_options import TownOptions
from nightcity.errors import UsageError
from nightcity.export.export_stage import export_stage
from nightcity.stage.write import write_stage

USUAL_CAMERAS = ("overview75", "street", "far25")


@dataclass(frozen=True)
class MeasuredScene:
    """A flat scene on disk. ``hash`` is docs/scene_format.md's, and covers all of it."""

    name: str
    folder: Path
    hash: str
    cameras: tuple[str, ...]

    def choose_cameras(self, asked: Sequence[str] | None) -> list[str]:
        """The cameras asked for, else those of USUAL_CAMERAS that are there.

        UsageError names the scene and its cameras where none fits.
        """
        chosen = list(asked or [name for name in USUAL_CAMERAS if name in self.cameras])
        missing = [name for name in chosen if name not in self.cameras]
        if missing or not chosen:
            what = f"--cameras {missing[0]}" if missing else "--cameras is missing"
            there = ", ".join(self.cameras) or "none"
            raise UsageError(f"{what}: the cameras of {self.name} are {there}")
        return chosen


def open_scene(
    source: str, work: Path, overrides: Mapping[str, object] | None = None
) -> MeasuredScene:
    """A preset by name (fields overridden), a stage or the folder of a flat scene by path.

    What has to be made is made in ``work``. UsageError says what a source may be.
    """
    path = Path(source)
    if source in preset_names():
        changes = "".join(f",{field}={_text(value)}" for field, value in (overrides or {}).items())
        return _export(generate(load_parameters(source, overrides)), source + changes, work)
    if overrides:
        raise UsageError(f"{source}: {', '.join(overrides)} can be set for presets only")
    if (path / "scene.json").is_file():
        return _read(path.name.removesuffix(".scene"), path)
    if path.is_file():
        folder = work / f"{path.stem}.scene"
        export_stage(path, folder)
        return _read(path.stem, folder)
    raise UsageError(
        f"{source}: neither a preset ({', '.join(preset_names())}) nor a stage nor the folder of "
        "a flat scene"
    )


def _text(value: object) -> str:
    if isinstance(value, tuple):
        return "x".join(map(_text, value))
    return value if isinstance(value, str) else f"{value:g}"


def open_town(file: Path, work: Path) -> MeasuredScene:
    """A CityJSON file, imported with the usual options."""
    if not file.is_file():
        raise UsageError(f"--town {file}: no such CityJSON file")
    return _export(import_town(file, TownOptions()), file.name.split(".")[0], work)


def _export(city: City, name: str, work: Path) -> MeasuredScene:
    stage, folder = work / f"{name}.usda", work / f"{name}.scene"
    write_stage(city, stage)
    export_stage(stage, folder)
    return _read(name, folder)


def _read(name: str, folder: Path) -> MeasuredScene:
    manifest = (folder / "scene.json").read_bytes()
    cameras = tuple(camera["name"] for camera in json.loads(manifest)["cameras"])
    return MeasuredScene(name, folder, xxhash.xxh3_128_hexdigest(manifest), cameras)
