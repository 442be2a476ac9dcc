# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What is read of a stage at a time, as plain arrays: all of it, or one district."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nightcity.export import emitters
from nightcity.export.cameras import CameraTrack, read_cameras
from nightcity.export.emitters import EmitterTable
from nightcity.export.findings import Findings
from nightcity.export.geometry import Geometry, joined_geometry, read_geometry
from nightcity.export.ground import Ground, read_grounds
from nightcity.export.lights import read_lights
from nightcity.export.materials import Materials, MaterialTable
from nightcity.export.media import Media, joined_media, read_media
from nightcity.export.notes import Notes
from nightcity.export.open_stage import Source, loaded_district, open_stage
from nightcity.export.walk import walk
from nightcity.export.windows import read_windows
from nightcity.parallel import in_order


@dataclass
class Part:
    """Places in metres on the stage, double precision; indices count within the part.

    building_ids: ``nightcity:buildingId`` of each building. emitters: unordered, with the ids of
    the stage. hidden_ids: of windows that no frame shows. is_empty: nothing is visible and
    renderable.
    """

    building_ids: list[int]
    geometry: Geometry
    materials: MaterialTable
    grounds: list[Ground]
    media: Media
    emitters: EmitterTable
    hidden_ids: NDArray[np.int64]
    cameras: list[CameraTrack]
    notes: Notes
    is_empty: bool


@dataclass(frozen=True)
class _District:
    """What a process needs to read one district."""

    stage: Path
    frames: tuple[int, int]
    path: str


def read_whole(source: Source, stage_path: Path) -> Part:
    """Everything on the stage; its districts are read by several processes.

    Raises SceneError naming the prim that cannot be read.
    """
    part = _read(source, walk(source))
    if not source.districts:
        return part
    work = [_District(stage_path, source.frames, path) for path in source.districts]
    return _joined(part, in_order(_read_district, work, len(work), "reading districts"))


def _read_district(district: _District) -> Part:
    source = _opened(district.stage, district.frames)
    with loaded_district(source, district.path) as loaded:
        return _read(loaded, walk(loaded, district.path))


@cache
def _opened(stage: Path, frames: tuple[int, int]) -> Source:
    """Once a process."""
    return open_stage(stage, frames)


def _read(source: Source, findings: Findings) -> Part:
    items = findings.items
    materials = Materials(source)
    geometry = read_geometry(source, items["geometry"], materials)
    grounds = read_grounds(source, items["ground"], materials)
    media = read_media(source, items["media"])
    windows, window_paths, hidden_ids = read_windows(
        source, items["windows"], findings.hidden_windows
    )
    lights, light_paths = read_lights(source, items["light"])
    table = emitters.joined(windows + lights, window_paths + light_paths)
    emitters.check(table)
    cameras = read_cameras(source, items["camera"])
    return Part(
        findings.building_ids, geometry, materials.table, grounds, media, table, hidden_ids,
        cameras, source.notes, not any(items.values()),
    )  # fmt: skip


def _joined(first: Part, others: Iterable[Part]) -> Part:
    """All parts as one; notes go to those of the first."""
    parts = [first, *_without_notes(others, first.notes)]
    buildings = np.cumsum([0] + [len(part.building_ids) for part in parts]).tolist()
    table = MaterialTable()
    materials = [table.take_in(part.materials) for part in parts]
    tables = [part.__dict__.pop("emitters") for part in parts]
    return Part(
        [number for part in parts for number in part.building_ids],
        joined_geometry([part.geometry for part in parts], materials, buildings),
        table,
        [
            Ground(ground.height, int(now[ground.material]), ground.path)
            for part, now in zip(parts, materials, strict=True)
            for ground in part.grounds
        ],
        joined_media([part.media for part in parts]),
        emitters.concatenated(tables, buildings),
        np.unique(np.concatenate([part.hidden_ids for part in parts])),
        [camera for part in parts for camera in part.cameras],
        first.notes,
        all(part.is_empty for part in parts),
    )


def _without_notes(parts: Iterable[Part], notes: Notes) -> Iterator[Part]:
    for part in parts:
        notes.take_in(part.notes)
        yield part
