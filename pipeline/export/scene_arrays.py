# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""From metres in double precision on the stage to the records of the file about its origin."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from nightcity.errors import SceneError
from nightcity.export.emitters import EmitterTable
from nightcity.export.geometry import Geometry
from nightcity.export.media import Media
from nightcity.export.notes import Notes
from nightcity.export.records import NONE, RECORDS, WINDOW_ON, WINDOW_SPHERE

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_ORIGIN_STEP = 1024.0  # m


def scene_origin(geometry: Geometry, table: EmitterTable, media: Media) -> FloatArray:
    """(3,) m: the multiple of 1,024 m nearest the middle of everything that has a place."""
    points = [geometry.positions, table.centre, media.lo, media.hi]
    lows = [array.min(axis=0) for array in points if len(array)]
    highs = [array.max(axis=0) for array in points if len(array)]
    if not lows:
        return np.zeros(3)
    middle = 0.5 * (np.min(lows, axis=0) + np.max(highs, axis=0))
    return np.round(middle / _ORIGIN_STEP) * _ORIGIN_STEP + 0.0  # no -0


def geometry_records(
    geometry: Geometry, origin: FloatArray, notes: Notes
) -> tuple[dict[str, NDArray], IntArray]:
    """The arrays position, texcoord and triangle, triangles by building with those of none last;
    and the building of each triangle, (T,), -1 for none. Triangles without area are dropped."""
    position = np.zeros(len(geometry.positions), RECORDS["position"])
    with np.errstate(over="ignore"):
        position["position"] = geometry.positions - origin
    if not np.isfinite(position["position"]).all():
        raise SceneError("the geometry reaches further than float32 can hold; check its units")
    solid = _has_area(position["position"], geometry.vertices)
    if not solid.all():
        notes.say(f"{np.count_nonzero(~solid)} triangles without area are dropped")
    kept = np.flatnonzero(solid)
    rank = geometry.buildings[kept]
    rank = np.where(rank < 0, np.iinfo(np.int64).max, rank)
    order = kept[np.argsort(rank, kind="stable")]
    triangle = np.zeros(len(order), RECORDS["triangle"])
    triangle["vertex"], triangle["material"] = geometry.vertices[order], geometry.materials[order]
    textured = geometry.texcoords is not None
    texcoord = np.zeros(len(position) if textured else 0, RECORDS["texcoord"])
    if textured:
        texcoord["texcoord"] = geometry.texcoords
    arrays = {"position": position, "texcoord": texcoord, "triangle": triangle}
    return arrays, geometry.buildings[order]


def _has_area(position: NDArray[np.float32], vertices: IntArray) -> NDArray[np.bool_]:
    corner = position.astype(np.float64)[vertices]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    return (normal != 0).any(axis=1)


def building_records(
    building_ids: Sequence[int], triangle_owner: IntArray, table: EmitterTable
) -> NDArray:
    """The array building; triangles and windows are sorted by it already."""
    records = np.zeros(len(building_ids), RECORDS["building"])
    records["building_id"] = building_ids
    for owner, name in ((triangle_owner, "triangle"), (table.building, "window")):
        counts = np.bincount(owner[owner >= 0], minlength=len(records))
        records[f"{name}_count"] = counts
        records[f"first_{name}"] = np.cumsum(counts) - counts
    return records


def window_records(table: EmitterTable, origin: FloatArray) -> NDArray:
    """The array window."""
    records = np.zeros(len(table), RECORDS["window"])
    with np.errstate(over="ignore"):  # found below
        records["centre"] = table.centre - origin
        records["half_u"], records["half_v"] = table.half_u, table.half_v
        records["power"], records["colour"] = table.power, table.colour
    records["building"] = np.where(table.building < 0, NONE, table.building)
    records["window_id"] = table.id
    records["flags"] = table.on * WINDOW_ON + table.sphere * WINDOW_SPHERE
    for name in ("centre", "half_u", "half_v", "power", "colour"):
        values = records[name]
        bad = ~np.isfinite(values).all(axis=tuple(range(1, values.ndim)))
        if bad.any():
            where = table.where(int(np.argmax(bad)))
            raise SceneError(f"{where}: its {name} is more than float32 can hold")
    with np.errstate(over="ignore"):
        bright = ~np.isfinite(records["power"][:, None] * records["colour"]).all(axis=1)
    if bright.any():
        where = table.where(int(np.argmax(bright)))
        raise SceneError(f"{where}: its power times its color is more than float32 can hold")
    return records


def event_records(table: EmitterTable) -> NDArray:
    """The array window_event."""
    records = np.zeros(len(table.event_row), RECORDS["window_event"])
    records["frame"], records["window"] = table.event_time, table.event_row
    records["on"] = table.event_on
    return records


def media_records(
    media: Media, offsets: IntArray, rows: IntArray, origin: FloatArray
) -> tuple[NDArray, NDArray]:
    """The arrays media_box and light_list."""
    records = np.zeros(len(media), RECORDS["media_box"])
    records["lo"], records["hi"] = media.lo - origin, media.hi - origin
    flat = ~(records["hi"] > records["lo"]).all(axis=1)
    flat |= ~np.isfinite(np.concatenate([records["lo"], records["hi"]], axis=1)).all(axis=1)
    if flat.any():
        raise SceneError(
            f"{media.path(int(np.argmax(flat)))}: the media box is thinner than float32 can hold"
            f" so far from the scene's origin {origin.tolist()}"
        )
    records["extinction"], records["albedo"] = media.extinction, media.albedo
    records["media_id"] = media.id
    records["first_light"], records["light_count"] = offsets[:-1], np.diff(offsets)
    lights = np.zeros(len(rows), RECORDS["light_list"])
    lights["window"] = rows
    return records, lights
