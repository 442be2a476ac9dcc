# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Windows: the instances of every PointInstancer with NightcityWindowsAPI."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from pxr import Usd

from nightcity.errors import SceneError
from nightcity.export.emitters import NO_ID
from nightcity.export.findings import Item
from nightcity.export.instancer import instance_masks, instance_transforms
from nightcity.export.open_stage import Source
from nightcity.progress import Progress

Columns = dict[str, NDArray]


def read_windows(
    source: Source, items: Sequence[Item], hidden: Sequence[Usd.Prim]
) -> tuple[list[Columns], list[str], NDArray[np.int64]]:
    """Columns of the table of emitters, a path for each item, and the ids of windows that no
    frame shows.

    hidden: instancers that are hidden as a whole. Raises SceneError naming the prim and the
    attribute that does not fit.
    """
    parts, paths = [], []
    hidden_ids = [_ids(prim, source) for prim in hidden]
    with Progress("reading windows", sum(len(item.matrices) for item in items)) as progress:
        for item in items:
            columns, unseen = _read(source, item)
            parts.append(columns)
            hidden_ids.append(unseen)
            paths.append(str(item.prim.GetPath()))
            progress.advance(len(item.matrices))
    return parts, paths, np.unique(np.concatenate([np.empty(0, np.int64), *hidden_ids]))


def _ids(prim: Usd.Prim, source: Source) -> NDArray[np.int64]:
    """The ids that an instancer states, (N,) or empty."""
    return np.array(source.value(prim, "ids", ()), dtype=np.int64)


def _read(source: Source, item: Item) -> tuple[Columns, NDArray[np.int64]]:
    """Every window of one instancer and of its copies; the ids of those that do not exist."""
    prim = item.prim
    transforms = instance_transforms(source, prim, with_prototype=True)
    count = len(transforms)
    times, states, exists = _states(source, item, count)
    kept = np.flatnonzero(exists)
    ids = _ids(prim, source)
    ids = ids if len(ids) else np.full(count, NO_ID)
    size = np.array(source.value(prim, "nightcity:windowSize"), dtype=np.float64)
    if not (np.isfinite(size) & (size > 0)).all():
        raise SceneError(f"{prim.GetPath()}.nightcity:windowSize is {size}; it must be above 0")
    world = (transforms[kept][None] @ item.matrices[:, None]).reshape(-1, 4, 4)
    copies, rows = len(item.matrices), len(world)
    changed = np.diff(states[:, kept].astype(np.int8), axis=0)
    step, column = np.nonzero(changed)
    shift = len(kept) * np.arange(copies)[:, None]
    columns = {
        "centre": world[:, 3, :3],
        "half_u": 0.5 * size[0] * world[:, 0, :3],
        "half_v": 0.5 * size[1] * world[:, 1, :3],
        "outward": world[:, 2, :3],
        "power": np.tile(_per_window(source, prim, "nightcity:power", count)[kept], copies),
        "colour": np.tile(_per_window(source, prim, "nightcity:color", count)[kept], (copies, 1)),
        "id": np.tile(ids[kept], copies),
        "building": np.repeat(item.buildings, len(kept)),
        "sphere": np.zeros(rows, bool),
        "foreign": np.zeros(rows, bool),
        "on": np.tile(states[0, kept], copies),
        "number": np.tile(kept, copies),
        "event_time": np.tile(np.array(times)[step + 1], copies),
        "event_row": (column + shift).reshape(-1),
        "event_on": np.tile(changed[step, column] > 0, copies),
    }
    return columns, ids[~exists]


def _states(
    source: Source, item: Item, count: int
) -> tuple[list[float], NDArray[np.bool_], NDArray[np.bool_]]:
    """Times (T,), which windows shine from each on (T, N), and which exist at all (N,).

    A window exists where it is visible at some frame; hidden, it is dark.
    """
    lit = item.prim.GetAttribute("nightcity:lightOn")
    lit_times = source.change_times(lit)
    lit_rows = [_light_on(item.prim, lit, time, count) for time in lit_times]
    mask_times, masks = instance_masks(source, item.prim, count)
    first = float(source.frames[0])
    later = [time for time in item.visible.times if time > first]
    if len(lit_times) == len(mask_times) == 1 and not later:
        shown = masks & item.visible.at(first)
        return lit_times, lit_rows[0] & shown, shown[0]
    times = sorted({*lit_times, *mask_times, *later})
    lit_at = np.searchsorted(lit_times, times, side="right") - 1
    mask_at = np.searchsorted(mask_times, times, side="right") - 1
    shown = masks[mask_at] & np.array([item.visible.at(time) for time in times])[:, None]
    return times, np.stack(lit_rows)[lit_at] & shown, shown.any(axis=0)


def _light_on(
    prim: Usd.Prim, attribute: Usd.Attribute, time: float, count: int
) -> NDArray[np.bool_]:
    values = attribute.Get(Usd.TimeCode(time))
    if values is None or len(values) == 0:
        return np.ones(count, dtype=bool)
    return _spread(prim, "nightcity:lightOn", np.array(values, dtype=bool), count)


def _per_window(source: Source, prim: Usd.Prim, name: str, count: int) -> NDArray[np.float64]:
    return _spread(prim, name, np.array(source.value(prim, name, ()), dtype=np.float64), count)


def _spread(prim: Usd.Prim, name: str, values: NDArray, count: int) -> NDArray:
    """One value a window, of one for all or one each."""
    if len(values) == count:
        return values
    if len(values) == 1:
        return np.repeat(values, count, axis=0)
    raise SceneError(
        f"{prim.GetPath()}.{name} has {len(values)} values; it needs 1, or one for each of the"
        f" {count} windows"
    )
