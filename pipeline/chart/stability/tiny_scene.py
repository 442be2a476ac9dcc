# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Flat scenes of a few windows, boxes of haze and walls, in which every frame is one view.

A sweep that varies the view or the lit window is one scene and one call of the renderer: the
animated camera ``view`` has a record a frame, and events switch the windows in between.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nightcity.export.records import NONE, RECORDS, WINDOW_ON
from nightcity.export.write import write_scene

CAMERA = "view"
# Corner c of a box has x from bit 0, y from bit 1, z from bit 2; anticlockwise from outside.
_FACES = ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))

_ONE_RAY = 1e-12  # tangent of a field of view whose pixels differ by less than float32 can tell

Vector = ArrayLike  # (3,) m


class TinyScene:
    """Fill it, then ``write`` it. Positions and lengths in metres, rounded to float32."""

    def __init__(self) -> None:
        self._windows: list[tuple] = []
        self._media: list[tuple] = []
        self._lists: list[Sequence[int] | None] = []
        self._walls: list[tuple[Vector, Vector]] = []
        self._views: list[tuple] = []
        self._lit: list[frozenset[int] | None] = []
        self.ground: float | None = None  # height, m
        # Last word on the arrays by name, before they are written.
        self.spoil: Callable[[dict[str, NDArray]], None] | None = None

    def window(
        self,
        centre: Vector,
        normal: Vector = (0, 1, 0),
        side: float = 1.0,
        power: float = 50.0,
    ) -> int:
        """A square pane of ``side`` metres that shines along ``normal``; returns its index."""
        half_u, half_v = (0.5 * side * axis for axis in _across(normal))
        self._windows.append((centre, power, half_u, NONE, half_v, len(self._windows), 1.0, 1))
        return len(self._windows) - 1

    def haze(
        self,
        lo: Vector,
        hi: Vector,
        extinction: float,
        albedo: float = 0.9,
        lights: Sequence[int] | None = None,
    ) -> None:
        """A media box; ``lights`` are the windows of its list, ascending (default: all)."""
        self._media.append((lo, extinction, hi, albedo, len(self._media), 0, 0, 0))
        self._lists.append(lights)

    def wall(self, lo: Vector, hi: Vector) -> None:
        """An opaque black box."""
        self._walls.append((lo, hi))

    def look(
        self,
        position: Vector,
        direction: Vector,
        lit: Iterable[int] | None = None,
        tangent: float = _ONE_RAY,
    ) -> None:
        """The next frame: the ray of the image's centre, which windows are on (default: all), and
        the tangent of half the vertical field of view (default: all pixels are one ray)."""
        forward = np.asarray(direction, float) / np.linalg.norm(direction)
        right, up = _across(-forward)
        self._views.append((position, tangent, right, 0.0, up, 0.0, forward, 1.0))
        self._lit.append(None if lit is None else frozenset(lit))

    @property
    def frames(self) -> int:
        """How many views there are."""
        return len(self._views)

    def write(self, folder: Path) -> Path:
        """Write the flat scene; returns the folder."""
        arrays = {name: np.zeros(0, record) for name, record in RECORDS.items()}
        arrays |= self._geometry()
        arrays["window"] = _records("window", self._windows)
        on = self._on()
        arrays["window"]["flags"] = np.where(on[0], WINDOW_ON, 0)
        arrays["window_event"] = _events(on)
        arrays["media_box"], arrays["light_list"] = self._lists_of_media()
        arrays["camera_frame"] = _records("camera_frame", self._views)
        if self.spoil:
            self.spoil(arrays)
        write_scene(folder, arrays, self._manifest())
        return folder

    def _on(self) -> NDArray[np.bool_]:
        """(frames, windows)."""
        on = np.ones((self.frames, len(self._windows)), bool)
        for row, lit in zip(on, self._lit, strict=True):
            if lit is not None:
                row[:] = False
                row[list(lit)] = True
        return on

    def _geometry(self) -> dict[str, NDArray]:
        corners, triangles = [], []
        for lo, hi in self._walls:
            for a, b, c, d in _FACES:
                base = len(corners) * 8
                triangles += [((base + a, base + b, base + c), 0)]
                triangles += [((base + a, base + c, base + d), 0)]
            corners.append([[(lo, hi)[c >> i & 1][i] for i in range(3)] for c in range(8)])
        position = np.zeros(8 * len(corners), RECORDS["position"])
        if corners:
            position["position"] = np.reshape(corners, (-1, 3))
        material = np.zeros(1, RECORDS["material"])
        material["first_texel"] = NONE
        return {
            "position": position,
            "triangle": _records("triangle", triangles),
            "material": material,
        }

    def _lists_of_media(self) -> tuple[NDArray, NDArray]:
        media = _records("media_box", self._media)
        lists = [range(len(self._windows)) if one is None else one for one in self._lists]
        media["light_count"] = [len(one) for one in lists]
        media["first_light"] = np.cumsum(media["light_count"]) - media["light_count"]
        lights = np.zeros(int(media["light_count"].sum()), RECORDS["light_list"])
        if len(lights):
            lights["window"] = np.concatenate([np.asarray(one, np.uint32) for one in lists])
        return media, lights

    def _manifest(self) -> dict[str, object]:
        ground = None if self.ground is None else {"height": self.ground, "material": 0}
        camera = {"name": CAMERA, "prim": f"/{CAMERA}", "first_frame": 1, "first": 0}
        return {
            "origin": [0.0, 0.0, 0.0],
            "cameras": [camera | {"count": self.frames}],
            "ground": ground,
            "frames": {"first": 1, "last": self.frames, "per_second": 24.0},
            "render": {"camera": CAMERA, "width": 0, "height": 0, "aovs": []},
            "notes": [],
        }


def _across(normal: Vector) -> tuple[NDArray, NDArray]:
    """Two unit vectors u, v with u x v = the unit normal, v upwards where there is an upwards."""
    normal = np.asarray(normal, float) / np.linalg.norm(normal)
    level = np.array([0.0, 0.0, 1.0] if abs(normal[2]) < 0.999 else [0.0, 1.0, 0.0])
    right = np.cross(level, normal)
    right /= np.linalg.norm(right)
    return right, np.cross(normal, right)


def _records(name: str, rows: list[tuple]) -> NDArray:
    records = np.zeros(len(rows), RECORDS[name])
    for record, row in zip(records, rows, strict=True):
        for field, value in zip(RECORDS[name].names, row, strict=True):
            record[field] = value
    return records


def _events(on: NDArray[np.bool_]) -> NDArray:
    frame, window = np.nonzero(on[1:] != on[:-1])
    events = np.zeros(len(frame), RECORDS["window_event"])
    events["frame"], events["window"] = frame + 2, window
    events["on"] = on[1:][frame, window]
    return events
