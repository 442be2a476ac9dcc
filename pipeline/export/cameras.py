# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Cameras as one record, or one a frame where they move."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from nightcity.errors import SceneError
from nightcity.export.findings import Item
from nightcity.export.open_stage import Source
from nightcity.export.records import RECORDS

_LENS = (
    "focalLength",
    "horizontalAperture",
    "verticalAperture",
    "horizontalApertureOffset",
    "verticalApertureOffset",
)


@dataclass
class CameraTrack:
    """A camera over the frames, or one record where it does not move.

    name, path: of the prim. records: (F,) camera_frame without positions. positions: (F, 3) m, on
    the stage.
    """

    name: str
    path: str
    records: NDArray
    positions: NDArray[np.float64]


def read_cameras(source: Source, items: Sequence[Item]) -> list[CameraTrack]:
    """Every perspective camera. Raises SceneError naming the one whose lens or transform is
    unusable."""
    return [_track(source, item.prim) for item in items if _is_perspective(source, item.prim)]


def camera_records(
    tracks: Sequence[CameraTrack], first_frame: int, origin: NDArray[np.float64]
) -> tuple[list[dict], NDArray]:
    """The manifest's ``cameras`` and the array ``camera_frame``, positions about origin (3,) m."""
    names = Counter(track.name for track in tracks)
    entries, arrays, first = [], [np.zeros(0, RECORDS["camera_frame"])], 0
    for track in tracks:
        records = track.records
        records["position"] = track.positions - origin
        entries.append(
            {
                "name": track.name if names[track.name] == 1 else track.path,
                "prim": track.path,
                "first_frame": first_frame,
                "first": first,
                "count": len(records),
            }
        )
        arrays.append(records)
        first += len(records)
    return entries, np.concatenate(arrays)


def _is_perspective(source: Source, prim: Usd.Prim) -> bool:
    path = prim.GetPath()
    if prim.GetAttribute("projection").Get(source.time) != UsdGeom.Tokens.perspective:
        source.notes.about("Orthographic cameras are left out", path)
        return False
    if (prim.GetAttribute("fStop").Get(source.time) or 0) > 0:
        source.notes.about("Depth of field is left out: every camera is a pinhole", path)
    return True


def _track(source: Source, prim: Usd.Prim) -> CameraTrack:
    first, last = source.frames
    frames = range(first, last + 1) if _moves(source, prim) else [first]
    read = [_record(source, prim, frame) for frame in frames]
    records = np.concatenate([record for record, _ in read])
    positions = np.array([position for _, position in read])
    if (records == records[0]).all() and (positions == positions[0]).all():
        records, positions = records[:1], positions[:1]
    return CameraTrack(prim.GetName(), str(prim.GetPath()), records, positions)


def _moves(source: Source, prim: Usd.Prim) -> bool:
    if any(source.varies(prim.GetAttribute(name)) for name in _LENS):
        return True
    while prim:
        if prim.IsA(UsdGeom.Xformable) and source.varies(UsdGeom.Xformable(prim)):
            return True
        prim = prim.GetParent()
    return False


def _record(source: Source, prim: Usd.Prim, frame: int) -> tuple[NDArray, NDArray[np.float64]]:
    """A camera_frame (1,) without its position, and the position (3,) m."""
    time, path = Usd.TimeCode(frame), prim.GetPath()
    lens = np.array([prim.GetAttribute(name).Get(time) for name in _LENS], dtype=np.float64)
    if not np.isfinite(lens).all() or (lens[:3] <= 0).any():
        raise SceneError(
            f"{path}: at frame {frame} its focal length and apertures must be finite and above 0,"
            f" but are {lens[0]:g}, {lens[1]:g} and {lens[2]:g}"
        )
    focal, width, height, offset_x, offset_y = lens
    world = UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(time)
    matrix = np.array(world) @ source.root
    across = np.cross(-matrix[2, :3], matrix[1, :3])
    if not np.isfinite(matrix).all() or not np.linalg.norm(across) > 0:
        raise SceneError(f"{path}: its transform at frame {frame} is flat or not finite")
    forward, right = _unit(-matrix[2, :3]), _unit(across)
    if np.linalg.det(matrix[:3, :3]) < 0:
        source.notes.about("A mirrored camera is taken unmirrored", path)
    record = np.zeros(1, RECORDS["camera_frame"])
    record["tan_half_fov"] = height / (2 * focal)
    record["right"], record["up"], record["forward"] = right, np.cross(right, forward), forward
    record["shift_x"], record["shift_y"] = 2 * offset_x / height, 2 * offset_y / height
    record["aspect"] = width / height
    return record, matrix[3, :3]


def _unit(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    return vector / np.linalg.norm(vector)
