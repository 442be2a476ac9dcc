# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""From a USD stage to a flat scene."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nightcity.errors import SceneError, UsageError
from nightcity.export import emitters
from nightcity.export.cameras import camera_records
from nightcity.export.ground import only_ground
from nightcity.export.lists import read_lists
from nightcity.export.media import settle_media
from nightcity.export.open_stage import Source, open_stage
from nightcity.export.part import Part, read_whole
from nightcity.export.render_settings import read_render_settings
from nightcity.export.scene_arrays import (
    building_records,
    event_records,
    geometry_records,
    media_records,
    scene_origin,
    window_records,
)
from nightcity.export.write import write_scene

LISTS = ("recomputed", "authored")


@dataclass(frozen=True)
class ExportReport:
    """What was written.

    folder: where. counts: records by array name. sizes: bytes by file name. notes: what was
    changed or left out, as in the file. seconds: wall time; it is in no file.
    """

    folder: Path
    counts: dict[str, int]
    sizes: dict[str, int]
    notes: list[str] = field(default_factory=list)
    seconds: float = 0.0

    def __str__(self) -> str:
        counted = ("building", "window", "media_box", "triangle", "light_list")
        parts = ", ".join(f"{self.counts[name]} {name}" for name in counted)
        size = sum(self.sizes.values()) / 1e6
        return f"{self.folder}: {parts} records, {size:.1f} MB in {self.seconds:.1f} s"


def export_stage(
    stage_path: Path | str,
    folder: Path | str,
    *,
    frames: tuple[int, int] | None = None,
    lists: str = "recomputed",
) -> ExportReport:
    """Write the flat scene of a stage into ``folder`` (docs/scene_format.md).

    frames: first and last; by default the stage's own time codes. lists: "recomputed" makes the
    light lists anew from the geometry, "authored" takes ``nightcity:windowLights``.
    Raises SceneError naming the file, prim or attribute that is wrong; the folder is then as it
    was. Progress goes to standard error.
    """
    started = time.monotonic()
    if lists not in LISTS:
        raise UsageError(f"lists must be one of {', '.join(LISTS)}, not '{lists}'")
    stage_path, folder = Path(stage_path), Path(folder)
    source = open_stage(stage_path, frames)
    part = read_whole(source, stage_path)
    _refuse_empty(stage_path, part)
    arrays, manifest = _flatten(source, part, lists)
    sizes = write_scene(folder, arrays, manifest)
    return ExportReport(
        folder,
        {name: len(array) for name, array in arrays.items()},
        sizes,
        list(manifest["notes"]),
        time.monotonic() - started,
    )


def _refuse_empty(path: Path, part: Part) -> None:
    if part.is_empty:
        raise SceneError(
            f"{path}: nothing on the stage is visible and renderable: no geometry, window, media"
            " box, light or camera"
        )


def _flatten(source: Source, part: Part, lists: str) -> tuple[dict[str, NDArray], dict]:
    """Every array of the file, and the manifest without what the writer adds."""
    geometry, media = part.geometry, part.media
    ground = only_ground(part.grounds)
    settle_media(media, source.notes, ground and ground.height)
    table = emitters.ordered(part.__dict__.pop("emitters"))
    original_ids = table.id.copy()
    emitters.number_uniquely(table, source.notes)
    offsets, rows = read_lists(source.notes, media, table, original_ids, part.hidden_ids, lists)
    origin = scene_origin(geometry, table, media)
    arrays, owners = geometry_records(geometry, origin, source.notes)
    arrays["building"] = building_records(part.building_ids, owners, table)
    arrays["material"], arrays["texel"] = part.materials.records()
    arrays["window"] = window_records(table, origin)
    arrays["window_event"] = event_records(table)
    arrays["media_box"], arrays["light_list"] = media_records(media, offsets, rows, origin)
    cameras, arrays["camera_frame"] = camera_records(part.cameras, source.frames[0], origin)
    render = read_render_settings(source, cameras)
    _note_what_is_missing(source, arrays)
    manifest = {
        "origin": origin.tolist(),
        "cameras": cameras,
        "ground": ground
        and {"height": float(np.float32(ground.height - origin[2])), "material": ground.material},
        "frames": {
            "first": source.frames[0],
            "last": source.frames[1],
            "per_second": source.frames_per_second,
        },
        "render": render,
        "notes": source.notes.sentences(),
    }
    return arrays, manifest


def _note_what_is_missing(source: Source, arrays: dict[str, NDArray]) -> None:
    for name, what in (
        ("camera_frame", "camera"),
        ("window", "window or light"),
        ("media_box", "media box"),
    ):
        if len(arrays[name]) == 0:
            source.notes.say(f"The scene has no {what}")
