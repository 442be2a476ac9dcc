# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Light lists: as the geometry has them, or as the stage authored them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nightcity.errors import SceneError
from nightcity.export.emitters import EmitterTable
from nightcity.export.media import Media
from nightcity.export.notes import Notes, named
from nightcity.light_lists import light_lists, window_bounds

IntArray = NDArray[np.int64]
_ABSENT, _HIDDEN = -1, -2  # what an id that lights nothing stands for


def read_lists(
    notes: Notes,
    media: Media,
    table: EmitterTable,
    original_ids: IntArray,
    hidden_ids: IntArray,
    choice: str,
) -> tuple[IntArray, IntArray]:
    """Offsets (M + 1,) and rows of the table: box i is lit by rows[offsets[i]:offsets[i + 1]].

    original_ids: (N,) ids as the stage has them. hidden_ids: of windows that no frame shows.
    choice: "recomputed" or "authored"; the stage's own lights come from geometry in both.
    Raises SceneError for an authored id that no window of the stage has.
    """
    offsets, rows = _from_geometry(media, table)
    box = np.repeat(np.arange(len(media)), np.diff(offsets))
    authored_box, ids = media.listed_box, media.listed_id
    meaning = _Meaning(table, original_ids, hidden_ids)
    authored_row = meaning.rows(ids)
    if choice == "authored":
        _refuse_unknown(media, authored_box, ids, authored_row)
        own = table.foreign[rows]
        known = authored_row >= 0
        pairs = _unique_pairs(
            len(table),
            np.concatenate([authored_box[known], box[own]]),
            np.concatenate([authored_row[known], rows[own]]),
        )
        counts = np.bincount(pairs[0], minlength=len(media))
        return np.concatenate([[0], np.cumsum(counts)]), pairs[1]
    _report_stale(notes, media, table, (box, rows), (authored_box, authored_row))
    return offsets, rows


def _from_geometry(media: Media, table: EmitterTable) -> tuple[IntArray, IntArray]:
    reach = np.linalg.norm(table.half_u, axis=1)[:, None]
    lo, hi = window_bounds(table.centre, table.half_u, table.half_v)
    lo = np.where(table.sphere[:, None], table.centre - reach, lo)
    hi = np.where(table.sphere[:, None], table.centre + reach, hi)
    return light_lists(lo, hi, media.lo, media.hi, media.reach_scale)


class _Meaning:
    """Which emitter an authored id means; the first one where several share it."""

    def __init__(self, table: EmitterTable, original_ids: IntArray, hidden_ids: IntArray) -> None:
        windows = np.flatnonzero(~table.foreign & (original_ids >= 0))
        self._ids, first = np.unique(original_ids[windows], return_index=True)
        self._rows = windows[first]
        self._hidden = hidden_ids

    def rows(self, ids: IntArray) -> IntArray:
        """(E,) rows of the table, _HIDDEN for windows that are not shown, else _ABSENT."""
        rows = np.full(len(ids), _ABSENT)
        rows[np.isin(ids, self._hidden)] = _HIDDEN
        if len(self._ids):
            at = np.minimum(np.searchsorted(self._ids, ids), len(self._ids) - 1)
            found = self._ids[at] == ids
            rows[found] = self._rows[at[found]]
        return rows


def _refuse_unknown(media: Media, box: IntArray, ids: IntArray, rows: IntArray) -> None:
    unknown = rows == _ABSENT
    if unknown.any():
        entry = int(np.argmax(unknown))
        raise SceneError(
            f"{media.path(box[entry])}.nightcity:windowLights names window {ids[entry]}, which the"
            f" stage does not have ({unknown.sum()} such entries): export with recomputed lists"
        )


def _unique_pairs(width: int, box: IntArray, row: IntArray) -> tuple[IntArray, IntArray]:
    keys = _ascending(box * max(width, 1) + row)
    return keys // max(width, 1), keys % max(width, 1)


def _ascending(keys: IntArray) -> IntArray:
    """Without repeats. Sorting is several times faster here than the hashing of np.unique."""
    keys = np.sort(keys)
    return keys[np.append(True, np.diff(keys) != 0)[: len(keys)]]


def _report_stale(
    notes: Notes,
    media: Media,
    table: EmitterTable,
    fresh: tuple[IntArray, IntArray],
    authored: tuple[IntArray, IntArray],
) -> None:
    """Say which authored lists the recomputed ones replace. Hidden windows make no list stale;
    the stage's own lights cannot be listed; instances of a box have no list of their own."""
    windows = ~table.foreign[fresh[1]]
    box, row = fresh[0][windows], fresh[1][windows]
    known = authored[1] != _HIDDEN
    width = len(table) + 1  # one more for absent windows
    ours = box * width + row
    theirs = _ascending(authored[0][known] * width + authored[1][known] % width)
    if np.array_equal(ours, theirs) and media.stated.all():
        return
    differs = np.zeros(len(media), dtype=bool)
    differs[np.setxor1d(ours, theirs, assume_unique=True) // width] = True
    for rows, what in (
        (np.flatnonzero(differs & media.stated & media.first_copy), "no longer fit the geometry"),
        (np.flatnonzero(differs & ~media.stated), "are missing"),
    ):
        if len(rows):
            paths = named([media.path(row) for row in rows])
            notes.say(
                f"The light lists of {len(rows)} of {len(media)} media boxes {what} and were"
                f" recomputed: {paths}"
            )
