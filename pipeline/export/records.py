# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The records of ``scene.bin`` as numpy types, as docs/scene_format.md lays them out.

Little endian, packed. shaders/shared/scene.h declares the same records for C++
and GLSL; a contract test holds the three together.
"""

from __future__ import annotations

import numpy as np

FORMAT = "nightcity-scene"
VERSION = 1
ALIGNMENT = 64  # bytes; every array starts at a multiple of it
NONE = 0xFFFFFFFF  # an index that points nowhere
WINDOW_ON = 1  # window flags: on at the first frame
WINDOW_SPHERE = 2  # window flags: a sphere of radius |half_u|

_F32, _U32, _I32 = "<f4", "<u4", "<i4"

RECORDS: dict[str, np.dtype] = {
    "position": np.dtype([("position", _F32, 3)]),
    "texcoord": np.dtype([("texcoord", _F32, 2)]),
    "triangle": np.dtype([("vertex", _U32, 3), ("material", _U32)]),
    "building": np.dtype(
        [
            ("first_triangle", _U32),
            ("triangle_count", _U32),
            ("first_window", _U32),
            ("window_count", _U32),
            ("building_id", _I32),
        ]
    ),
    "material": np.dtype(
        [("reflectance", _F32, 3), ("first_texel", _U32), ("width", _U32), ("height", _U32)]
    ),
    "texel": np.dtype([("rgba", "u1", 4)]),
    "window": np.dtype(
        [
            ("centre", _F32, 3),
            ("power", _F32),
            ("half_u", _F32, 3),
            ("building", _U32),
            ("half_v", _F32, 3),
            ("window_id", _U32),
            ("colour", _F32, 3),
            ("flags", _U32),
        ]
    ),
    "media_box": np.dtype(
        [
            ("lo", _F32, 3),
            ("extinction", _F32),
            ("hi", _F32, 3),
            ("albedo", _F32),
            ("media_id", _I32),
            ("first_light", _U32),
            ("light_count", _U32),
            ("reserved", _U32),
        ]
    ),
    "light_list": np.dtype([("window", _U32)]),
    "window_event": np.dtype([("frame", _F32), ("window", _U32), ("on", _U32)]),
    "camera_frame": np.dtype(
        [
            ("position", _F32, 3),
            ("tan_half_fov", _F32),
            ("right", _F32, 3),
            ("shift_x", _F32),
            ("up", _F32, 3),
            ("shift_y", _F32),
            ("forward", _F32, 3),
            ("aspect", _F32),
        ]
    ),
}

_TYPE_NAMES = {"f": "f32", "u": "u32", "i": "i32"}


def fields(name: str) -> list[list]:
    """Field list of one record for the manifest: [name, type, components, byte offset]."""
    record = RECORDS[name]
    rows = []
    for field in record.names:
        dtype, offset = record.fields[field][:2]
        base = dtype.base
        kind = "u8" if base.itemsize == 1 else _TYPE_NAMES[base.kind]
        rows.append([field, kind, int(np.prod(dtype.shape, dtype=int)), offset])
    return rows
