# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The table of emitters that windows and the stage's own lights fill, checked and ordered."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from nightcity.errors import SceneError
from nightcity.export.notes import Notes
from nightcity.export.records import NONE

FloatArray = NDArray[np.float64]
NO_ID = -1  # a window that brings no id of its own
_SQUARE = 1e-3  # largest cosine between the edges of a rectangle


@dataclass
class EmitterTable:
    """One row an emitter.

    centre, half_u, half_v: (N, 3) m, half_u x half_v outward. power: (N,) W. colour: (N, 3).
    id: (N,) NO_ID where there is none. building: (N,) or -1. sphere: (N,) a ball of radius
    |half_u|. on: (N,) at the first frame. owner: (N,) into paths; number: (N,) the instance.
    event_time, event_row, event_on: (E,) changes after the first frame, rows into the table.
    foreign: (N,) whether it is a light of the stage rather than a window.
    """

    centre: FloatArray
    half_u: FloatArray
    half_v: FloatArray
    power: FloatArray
    colour: FloatArray
    id: NDArray[np.int64]
    building: NDArray[np.int64]
    sphere: NDArray[np.bool_]
    foreign: NDArray[np.bool_]
    on: NDArray[np.bool_]
    owner: NDArray[np.int64]
    number: NDArray[np.int64]
    event_time: FloatArray
    event_row: NDArray[np.int64]
    event_on: NDArray[np.bool_]
    paths: list[str]

    def __len__(self) -> int:
        return len(self.id)

    def where(self, row: int) -> str:
        """The prim that a row comes from, for messages."""
        path = self.paths[self.owner[row]]
        return path if self.foreign[row] else f"{path} (instance {self.number[row]})"


_EVENTS = ("event_time", "event_row", "event_on")
ROWS = tuple(f.name for f in fields(EmitterTable) if f.name not in (*_EVENTS, "paths"))
_SHAPES = {"centre": (3,), "half_u": (3,), "half_v": (3,), "colour": (3,), "outward": (3,)}
_TYPES = {
    "id": np.int64, "building": np.int64, "owner": np.int64, "number": np.int64,
    "event_row": np.int64, "sphere": bool, "foreign": bool, "on": bool, "event_on": bool,
}  # fmt: skip


def joined(parts: list[dict[str, NDArray]], paths: list[str]) -> EmitterTable:
    """One table of parts that hold every row and event array each; part i comes from paths[i].

    event_row counts within its part. Each part also has ``outward`` (N, 3), the side to which
    half_u x half_v is made to point: a mirrored transform keeps the lit side.
    """
    counts = np.array([len(part["id"]) for part in parts], dtype=np.int64)
    starts = np.cumsum(counts) - counts
    columns = {}
    for name in (*ROWS, *_EVENTS, "outward"):
        if name == "owner":
            columns[name] = np.repeat(np.arange(len(parts)), counts)
            continue
        empty = np.empty((0, *_SHAPES.get(name, ())), _TYPES.get(name, np.float64))
        arrays = [part[name] for part in parts]
        if name == "event_row":
            arrays = [rows + start for rows, start in zip(arrays, starts, strict=True)]
        columns[name] = np.concatenate([empty, *arrays])
    outward = columns.pop("outward")
    along = np.einsum("ni,ni->n", np.cross(columns["half_u"], columns["half_v"]), outward)
    columns["half_u"][along < 0] *= -1
    return EmitterTable(**columns, paths=paths)


def concatenated(tables: list[EmitterTable], buildings: list[int]) -> EmitterTable:
    """One table after the other; the buildings of table i count from buildings[i]. Empties the
    list, column by column: a large city fits twice in no memory."""
    if len(tables) == 1:
        return tables.pop()
    sizes = np.array([len(table) for table in tables], dtype=np.int64)
    rows = np.cumsum(sizes) - sizes
    prims = np.cumsum([0] + [len(table.paths) for table in tables])
    for table, row, prim, building in zip(tables, rows, prims, buildings, strict=False):
        table.event_row += row
        table.owner += prim
        table.building[table.building >= 0] += building
    paths = [path for table in tables for path in table.paths]
    columns = {}
    for name in (*ROWS, *_EVENTS):
        columns[name] = np.concatenate([vars(table).pop(name) for table in tables])
    tables.clear()
    return EmitterTable(**columns, paths=paths)


def check(table: EmitterTable) -> None:
    """Raises SceneError naming the first pane that is not finite, flat, square or positive."""
    numbers = np.concatenate([table.centre, table.half_u, table.half_v], axis=1)
    _refuse(table, ~np.isfinite(numbers).all(axis=1), "its position or size is not finite")
    colour = np.concatenate([table.power[:, None], table.colour], axis=1)
    bad = ~(np.isfinite(colour) & (colour >= 0)).all(axis=1)
    _refuse(table, bad, "its power and colour must be finite and not negative")
    u, v = (np.linalg.norm(half, axis=1) for half in (table.half_u, table.half_v))
    tiny = np.finfo(np.float32).tiny
    _refuse(table, u * v < tiny, "it has no width or no height")
    cosine = np.abs(np.einsum("ni,ni->n", table.half_u, table.half_v)) / np.maximum(u * v, tiny)
    _refuse(
        table,
        cosine > _SQUARE,
        "its transform shears it; the edges of an emitter must stay perpendicular within 1e-3",
    )


def _refuse(table: EmitterTable, bad: NDArray[np.bool_], what: str) -> None:
    if bad.any():
        row = int(np.argmax(bad))
        more = f" (and so are {bad.sum() - 1} more)" if bad.sum() > 1 else ""
        raise SceneError(f"{table.where(row)}: {what}{more}")


def number_uniquely(table: EmitterTable, notes: Notes) -> None:
    """Give every emitter an id of its own: those that are missing, repeated or too large for 32
    bits become new ones above all others, with a note."""
    usable = (table.id >= 0) & (table.id < NONE)
    keeps = np.zeros(len(table), dtype=bool)
    candidates = np.flatnonzero(usable)
    keeps[candidates[np.unique(table.id[candidates], return_index=True)[1]]] = True
    fresh = np.flatnonzero(~keeps)
    first = int(table.id[keeps].max(initial=-1)) + 1
    new = np.arange(first, first + len(fresh))
    if first + len(fresh) > NONE:  # no room above: the lowest free ids
        new = np.setdiff1d(np.arange(len(table)), table.id[keeps])[: len(fresh)]
    table.id[fresh] = new
    for owner in np.unique(table.owner[fresh[~table.foreign[fresh]]]):
        notes.about(
            "Windows whose ids are missing, repeated or beyond 32 bits have got new ids",
            table.paths[owner],
        )


def ordered(table: EmitterTable) -> EmitterTable:
    """Windows by building, then those of none, then the stage's lights;
    events by time, then row."""
    last = int(table.building.max(initial=-1)) + 1
    rank = np.where(table.building < 0, last, table.building)
    order = np.argsort(np.where(table.foreign, last + 1, rank), kind="stable")
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    columns = {name: getattr(table, name) for name in ROWS}
    if (place != order).any():  # a large city fits twice in no memory
        columns = {name: column[order] for name, column in columns.items()}
    row, frame = place[table.event_row], table.event_time.astype(np.float32)
    by_time = np.lexsort((table.event_time, row, frame))
    # Of several events that fall on one float32 frame the last one counts.
    follows = (np.diff(row[by_time]) == 0) & (np.diff(frame[by_time]) == 0)
    kept = by_time[~np.append(follows, np.zeros(min(len(row), 1), bool))]
    columns |= {"event_time": table.event_time[kept], "event_row": row[kept]}
    return EmitterTable(**columns, event_on=table.event_on[kept], paths=table.paths)
