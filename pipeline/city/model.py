# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A city as plain records: what generators and importers make and the stage writer reads.

Right-handed, z up, metres, watts. Arrays are double precision; nothing here knows USD.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True)
class Material:
    """A Lambertian surface.

    name: unique, a valid USD identifier.
    reflectance: linear Rec. 709, each 0 to 1; multiplies the texture.
    texture: (rows, columns, 3) uint8, sRGB, top row first, repeating; or None.
    """

    name: str
    reflectance: tuple[float, float, float]
    texture: NDArray[np.uint8] | None = None


@dataclass(frozen=True)
class Mesh:
    """Planar polygons, counter-clockwise seen from outside, about the building's origin.

    positions: (V, 3) m. counts: (F,) vertices a face. indices: (sum of counts,) into positions.
    materials: (F,) into ``City.materials``. texcoords: (sum of counts, 2) a face corner, or None.
    """

    positions: FloatArray
    counts: IntArray
    indices: IntArray
    materials: IntArray
    texcoords: FloatArray | None = None


@dataclass(frozen=True)
class Windows:
    """The windows of one building, about the building's origin.

    centres, half_u, half_v: (N, 3) m; half_u is half the width, half_v half the height, and
    half_u x half_v points outward. power: (N,) W when on. colours: (N, 3) multiply the power.
    light_on: (N,) at the first frame. ids: (N,) unique in the city, not negative.
    switches: (E, 2) the window, a row of these arrays, and the frame from which on it is the other
    way; by frame, then window, each pair once, after the first frame.
    """

    centres: FloatArray
    half_u: FloatArray
    half_v: FloatArray
    power: FloatArray
    colours: FloatArray
    light_on: BoolArray
    ids: IntArray
    switches: IntArray = field(default_factory=lambda: np.zeros((0, 2), np.int64))

    def __len__(self) -> int:
        return len(self.ids)


@dataclass(frozen=True)
class Building:
    """One building: its mesh and windows lie about ``origin`` (3,) m, without rotation."""

    building_id: int
    origin: FloatArray
    mesh: Mesh
    windows: Windows
    name: str = ""


@dataclass(frozen=True)
class MediaBox:
    """Homogeneous haze in an axis-aligned box.

    lo, hi: (3,) m. extinction: 1/m. albedo: 0 to 1. reach_scale: how much larger the box is
    taken when the windows that light it are listed (the paper: 1.2, corner boxes 1.5).
    """

    media_id: int
    lo: FloatArray
    hi: FloatArray
    extinction: float
    albedo: float
    reach_scale: float = 1.2


@dataclass(frozen=True)
class Camera:
    """A pinhole camera; up is z. Position and target in m, vertical field of view in degrees.

    track: (F, 6) position and target at each frame of the city, or None where it does not move.
    """

    name: str
    position: tuple[float, float, float]
    target: tuple[float, float, float]
    vertical_fov_degrees: float
    track: FloatArray | None = None


@dataclass(frozen=True)
class LightLists:
    """Which windows light which media box: box i holds ``window_ids[offsets[i]:offsets[i + 1]]``.

    offsets: (boxes + 1,). window_ids: ids as in ``Windows.ids``, ascending within a box.
    """

    offsets: IntArray
    window_ids: IntArray


@dataclass(frozen=True)
class City:
    """Everything that a stage is written from.

    name: a valid USD identifier. ground_material: into ``materials``; the ground is the plane
    z = ``ground_height`` (m), or there is none where ground_material is None.
    origin_offset: where the local origin lies in the source's own coordinates (m, double).
    crs: the source's coordinate reference system, or "".
    parameters: what the city was made from, JSON-able, kept as metadata.
    resolution: default frame, width and height in pixels. frames: how many, counted from 1.
    notes: what an importer skipped.
    """

    name: str
    buildings: tuple[Building, ...]
    media: tuple[MediaBox, ...]
    light_lists: LightLists
    cameras: tuple[Camera, ...]
    materials: tuple[Material, ...]
    ground_material: int | None
    ground_height: float = 0.0
    origin_offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    crs: str = ""
    parameters: Mapping[str, object] = field(default_factory=dict)
    resolution: tuple[int, int] = (1920, 1061)
    frames: int = 1
    notes: tuple[str, ...] = ()
