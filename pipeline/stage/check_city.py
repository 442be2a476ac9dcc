# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Checks the records of a city once, before anything is written."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable

import numpy as np

from nightcity.city.model import Building, Camera, City, Material, MediaBox, Windows
from nightcity.errors import SceneError
from nightcity.stage.attributes import identifier

_LARGEST_ID = 2**31 - 1  # nightcity:windowLights holds 32-bit integers


def check_city(city: City) -> None:
    """Raise SceneError, naming the record and the field, unless a stage can be written."""
    check_whole(city)
    check_parts(city)


def check_whole(city: City) -> None:
    """What the city says as a whole: names and numbers used once, lists that fit the windows."""
    _require(identifier(city.name), "the city", "name", f"{city.name!r} is no USD identifier")
    _require(
        np.isfinite([*city.origin_offset, city.ground_height]).all(),
        "the city",
        "origin_offset and ground_height",
        "must be finite",
    )
    try:
        json.dumps(dict(city.parameters), allow_nan=False)
    except (TypeError, ValueError) as error:
        raise SceneError(f"the city: parameters cannot be written as JSON: {error}") from error
    width, height = city.resolution
    _require(width > 0 and height > 0, "the city", "resolution", "must be above 0")
    _unique((material.name for material in city.materials), "material name")
    _unique((camera.name for camera in city.cameras), "camera name")
    _unique((building.building_id for building in city.buildings), "building_id")
    _unique((box.media_id for box in city.media), "media_id")
    for material in city.materials:
        _check_material(material)
    if city.ground_material is not None:
        _require(
            0 <= city.ground_material < len(city.materials),
            "the city",
            "ground_material",
            f"{city.ground_material} is none of {len(city.materials)} materials",
        )
    _require(city.frames >= 1, "the city", "frames", "must be 1 or more")
    for camera in city.cameras:
        _check_camera(camera, city.frames)
    _check_light_lists(city)


def check_parts(city: City) -> None:
    """Each building and each media box on its own, as they are in a city or in one district."""
    for building in city.buildings:
        where = f"building {building.building_id}"
        _require(0 <= building.building_id <= _LARGEST_ID, where, "building_id", "out of range")
        _check_mesh(building, where, len(city.materials))
        _check_windows(building, where)
        _check_switches(building.windows, where, city.frames)
    for box in city.media:
        _check_media_box(box)


def _require(holds: bool | np.bool_, where: str, field: str, message: str) -> None:
    if not holds:
        raise SceneError(f"{where}: {field}: {message}")


def _unique(values: Iterable[object], what: str) -> None:
    twice = [value for value, count in Counter(values).items() if count > 1]
    if twice:
        raise SceneError(f"the city: {what} {twice[0]!r} is used more than once")


def _check_material(material: Material) -> None:
    where = f"material {material.name}"
    _require(identifier(material.name), where, "name", "is no USD identifier")
    colour = np.asarray(material.reflectance, float)
    _require(
        colour.shape == (3,) and ((colour >= 0) & (colour <= 1)).all(),
        where,
        "reflectance",
        "must be three values from 0 to 1",
    )
    if (texture := material.texture) is not None:
        whole = texture.ndim == 3 and texture.shape[2] == 3 and texture.size > 0
        _require(
            whole and texture.dtype == np.uint8,
            where,
            "texture",
            "must be (rows, columns, 3) uint8",
        )


def _check_mesh(building: Building, where: str, material_count: int) -> None:
    mesh = building.mesh
    _require(
        np.shape(building.origin) == (3,) and np.isfinite(building.origin).all(),
        where,
        "origin",
        "must be three finite values",
    )
    _require(
        mesh.positions.ndim == 2
        and mesh.positions.shape[1] == 3
        and np.isfinite(mesh.positions).all(),
        where,
        "mesh.positions",
        "must be (vertices, 3) and finite",
    )
    corners = int(mesh.counts.sum())
    _require((mesh.counts >= 3).all(), where, "mesh.counts", "a face needs at least 3 vertices")
    _require(len(mesh.indices) == corners, where, "mesh.indices", f"must hold {corners} values")
    _require(
        ((mesh.indices >= 0) & (mesh.indices < len(mesh.positions))).all(),
        where,
        "mesh.indices",
        f"must lie in 0 to {len(mesh.positions) - 1}",
    )
    _require(
        mesh.materials.shape == mesh.counts.shape
        and ((mesh.materials >= 0) & (mesh.materials < material_count)).all(),
        where,
        "mesh.materials",
        f"must be one value a face, 0 to {material_count - 1}",
    )
    if mesh.texcoords is not None:
        _require(
            mesh.texcoords.shape == (corners, 2) and np.isfinite(mesh.texcoords).all(),
            where,
            "mesh.texcoords",
            f"must be ({corners}, 2) and finite",
        )


def _check_windows(building: Building, where: str) -> None:
    windows = building.windows
    count = len(windows)
    for field, shape in (
        ("centres", (count, 3)),
        ("half_u", (count, 3)),
        ("half_v", (count, 3)),
        ("colours", (count, 3)),
        ("power", (count,)),
        ("light_on", (count,)),
    ):
        array = getattr(windows, field)
        _require(array.shape == shape, where, f"windows.{field}", f"must have the shape {shape}")
        _require(np.isfinite(array).all(), where, f"windows.{field}", "must be finite")
    _require((windows.power >= 0).all(), where, "windows.power", "must not be negative")
    _require((windows.colours >= 0).all(), where, "windows.colours", "must not be negative")
    area = np.linalg.norm(np.cross(windows.half_u, windows.half_v), axis=1)
    edges = np.linalg.norm(windows.half_u, axis=1) * np.linalg.norm(windows.half_v, axis=1)
    _require((area > 0).all(), where, "windows.half_u and half_v", "must span a rectangle")
    _require(
        (area >= (1 - 1e-6) * edges).all(),
        where,
        "windows.half_u and half_v",
        "must be at right angles",
    )
    _require(
        ((windows.ids >= 0) & (windows.ids <= _LARGEST_ID)).all(),
        where,
        "windows.ids",
        f"must lie in 0 to {_LARGEST_ID}",
    )


def _check_switches(windows: Windows, where: str, frames: int) -> None:
    row, frame = windows.switches.T
    _require(((row >= 0) & (row < len(windows))).all(), where, "windows.switches", "no such window")
    _require(
        ((frame > 1) & (frame <= frames)).all(),
        where,
        "windows.switches",
        f"must lie after frame 1, up to {frames}",
    )
    order = frame * max(len(windows), 1) + row
    _require((np.diff(order) > 0).all(), where, "windows.switches", "must rise by frame, window")


def _check_media_box(box: MediaBox) -> None:
    where = f"media box {box.media_id}"
    _require(0 <= box.media_id <= _LARGEST_ID, where, "media_id", "out of range")
    corners = np.array([box.lo, box.hi], float)
    _require(
        corners.shape == (2, 3) and np.isfinite(corners).all(), where, "lo and hi", "must be finite"
    )
    _require((corners[0] < corners[1]).all(), where, "lo and hi", "lo must be below hi")
    _require(0 <= box.extinction < np.inf, where, "extinction", "must be 0 or more")
    _require(0 <= box.albedo <= 1, where, "albedo", "must lie in 0 to 1")
    _require(0 < box.reach_scale < np.inf, where, "reach_scale", "must be above 0")


def _check_camera(camera: Camera, frames: int) -> None:
    where = f"camera {camera.name}"
    _require(identifier(camera.name), where, "name", "is no USD identifier")
    line = np.array([camera.position, camera.target], float)
    _require(np.isfinite(line).all(), where, "position and target", "must be finite")
    _require((line[0] != line[1]).any(), where, "target", "must not be the position")
    if (track := camera.track) is not None:
        whole = track.shape == (frames, 6) and np.isfinite(track).all()
        _require(whole, where, "track", f"must be ({frames}, 6) and finite")
        _require((track[:, :3] != track[:, 3:]).any(axis=1).all(), where, "track", "looks nowhere")
    _require(
        0 < camera.vertical_fov_degrees < 180, where, "vertical_fov_degrees", "must lie in 0 to 180"
    )


def _check_light_lists(city: City) -> None:
    lists = city.light_lists
    _require(
        lists.offsets.shape == (len(city.media) + 1,)
        and lists.offsets[0] == 0
        and (np.diff(lists.offsets) >= 0).all()
        and lists.offsets[-1] == len(lists.window_ids),
        "the city",
        "light_lists.offsets",
        "must rise from 0 to the number of window_ids, one more than there are media boxes",
    )
    ids = np.concatenate([building.windows.ids for building in city.buildings] or [[]])
    known, counts = np.unique(ids, return_counts=True)
    if (counts > 1).any():
        raise SceneError(
            f"the city: window id {int(known[counts > 1][0])} is used more than once;"
            " number the windows of all buildings together"
        )
    strange = ~np.isin(lists.window_ids, known)
    if strange.any():
        raise SceneError(
            f"the city: light_lists.window_ids: {int(lists.window_ids[strange][0])} is no window"
        )
