# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Cameras as one record, or one a frame where they move."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

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


def read_cameras(
    source: Source, items: Sequence[Item], origin: NDArray[np.float64]
) -> tuple[list[dict], NDArray]:
    """The manifest's ``cameras`` and the array ``camera_frame``, positions about origin (3,) m.

    Raises SceneError naming the camera whose lens or transform is unusable.
    """
    items = [item for item in items if _is_perspective(source, item.prim)]
    names = Counter(item.prim.GetName() for item in items)
    entries, tracks, first = [], [], 0
    for item in items:
        prim = item.prim
        track = _track(source, prim, origin)
        path, name = str(prim.GetPath()), prim.GetName()
        entries.append(
            {
                "name": name if names[name] == 1 else path,
                "prim": path,
                "first_frame": source.frames[0],
                "first": first,
                "count": len(track),
            }
        )
        tracks.append(track)
        first += len(track)
    return entries, np.concatenate([np.zeros(0, RECORDS["camera_frame"]), *tracks])


def _is_perspective(source: Source, prim: Usd.Prim) -> bool:
    path = prim.GetPath()
    if prim.GetAttribute("projection").Get(source.time) != UsdGeom.Tokens.perspective:
        source.notes.about("Orthographic cameras are left out", path)
        return False
    if (prim.GetAttribute("fStop").Get(source.time) or 0) > 0:
        source.notes.about("Depth of field is left out: every camera is a pinhole", path)
    return True


def _track(source: Source, prim: Usd.Prim, origin: NDArray[np.float64]) -> NDArray:
    first, last = source.frames
    frames = range(first, last + 1) if _moves(source, prim) else [first]
    track = np.concatenate([_record(source, prim, frame, origin) for frame in frames])
    return track[:1] if (track == track[0]).all() else track


def _moves(source: Source, prim: Usd.Prim) -> bool:
    if any(source.varies(prim.GetAttribute(name)) for name in _LENS):
        return True
    while prim:
        if prim.IsA(UsdGeom.Xformable) and source.varies(UsdGeom.Xformable(prim)):
            return True
        prim = prim.GetParent()
    return False


def _record(source: Source, prim: Usd.Prim, frame: int, origin: NDArray[np.float64]) -> NDArray:
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
    record["position"] = matrix[3, :3] - origin
    record["tan_half_fov"] = height / (2 * focal)
    record["right"], record["up"], record["forward"] = right, np.cross(right, forward), forward
    record["shift_x"], record["shift_y"] = 2 * offset_x / height, 2 * offset_y / height
    record["aspect"] = width / height
    return record


def _unit(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    return vector / np.linalg.norm(vector)
