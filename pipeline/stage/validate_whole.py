# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Checks across a whole stage: numbers used once, boxes that overlap, lists that fit."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf

from nightcity.box_overlaps import box_overlaps
from nightcity.light_lists import light_lists
from nightcity.stage.facts import NO_NUMBER, Facts
from nightcity.stage.finding import Finding

_MOST_OVERLAPS = 50  # named; more than that have one cause
_SAME_FACE = 1e-4  # m; the export moves faces closer than this onto each other


def check_window_ids(facts: Facts) -> Iterator[Finding]:
    """Ids of windows are used once on the stage."""
    owner = np.repeat(np.arange(len(facts.windows)), facts.id_counts)
    order = np.lexsort((owner, facts.ids))
    reported = set()
    for place in np.flatnonzero(np.diff(facts.ids[order]) == 0).tolist():
        first, second = (int(owner[order[place + step]]) for step in (0, 1))
        if second not in reported:
            reported.add(second)
            yield facts.windows.twice(
                second,
                "ids",
                f"window {facts.ids[order[place]]} is also in {facts.windows.paths[first]}; ids"
                " must be used once on the stage, so renumber one of them",
            )


def check_media_ids(facts: Facts) -> Iterator[Finding]:
    for row, first in _used_before(facts.media_ids):
        yield facts.boxes.twice(
            row,
            "nightcity:mediaId",
            f"{facts.media_ids[row]} is also the number of {facts.boxes.paths[first]}; give each"
            " box its own",
        )


def check_building_ids(facts: Facts) -> Iterator[Finding]:
    for row, first in _used_before(facts.building_ids):
        yield facts.buildings.twice(
            row,
            "nightcity:buildingId",
            f"{facts.building_ids[row]} is also that of {facts.buildings.paths[first]}; renumber",
        )


def _used_before(numbers: NDArray[np.int64]) -> Iterator[tuple[int, int]]:
    """Rows whose number an earlier row has, with the first that has it."""
    _, first, inverse = np.unique(numbers, return_index=True, return_inverse=True)
    rows = np.flatnonzero((first[inverse] != np.arange(len(numbers))) & (numbers != NO_NUMBER))
    yield from zip(rows.tolist(), first[inverse[rows]].tolist(), strict=True)


def check_overlaps(facts: Facts) -> Iterator[Finding]:
    whole = _whole_boxes(facts)
    corners = facts.corners[whole]
    if not len(corners):
        return
    shrunk = corners[:, 0] + 0.5 * _SAME_FACE, corners[:, 1] - 0.5 * _SAME_FACE
    pairs = whole[box_overlaps(*shrunk, _MOST_OVERLAPS + 1)].tolist()
    for first, second in pairs[:_MOST_OVERLAPS]:
        yield facts.boxes.error(
            second,
            "xformOpOrder",
            f"overlaps {facts.boxes.paths[first]}; boxes may touch but not overlap, so move or cut"
            " one of them",
        )
    if len(pairs) > _MOST_OVERLAPS:
        parent = str(Sdf.Path(facts.boxes.paths[whole[0]]).GetParentPath())
        yield Finding("error", parent, "", f"more than {_MOST_OVERLAPS} pairs of boxes overlap")


def _whole_boxes(facts: Facts) -> NDArray[np.int64]:
    """Rows of the boxes that are boxes; others are reported on their own."""
    return np.flatnonzero(np.isfinite(facts.corners).all(axis=(1, 2)))


def check_lists(facts: Facts) -> Iterator[Finding]:
    """What boxes list is there, in order, and what the rule gives for the geometry as it is."""
    starts = np.cumsum(facts.list_counts) - facts.list_counts
    owner = np.repeat(np.arange(len(facts.boxes)), facts.list_counts)
    unknown = ~np.isin(facts.listed, facts.ids)
    strange = np.bincount(owner[unknown], minlength=len(facts.boxes))
    falls = (np.diff(facts.listed) <= 0) & (np.diff(owner) == 0)
    unsorted = np.bincount(owner[1:][falls], minlength=len(facts.boxes))
    for row in np.flatnonzero(strange).tolist():
        run = slice(starts[row], starts[row] + facts.list_counts[row])
        yield facts.boxes.error(
            row,
            "nightcity:windowLights",
            f"lists window {facts.listed[run][unknown[run]][0]}, which is in no instancer's ids"
            f" ({strange[row]} of {facts.list_counts[row]} are not); correct the list, or clear it"
            " and let the export compute it",
        )
    for row in np.flatnonzero((unsorted > 0) & (strange == 0)).tolist():
        yield facts.boxes.warning(row, "nightcity:windowLights", "is not ascending; sort it")
    yield from _check_stale(facts, owner)


def _check_stale(facts: Facts, owner: NDArray[np.int64]) -> Iterator[Finding]:
    whole = _whole_boxes(facts)
    reach = facts.reach[whole]
    comparable = (
        facts.bounded
        and len(facts.bounds) == len(facts.ids) > 0
        and np.isfinite(facts.bounds).all()
        and (np.isfinite(reach) & (reach > 0)).all()  # else reported with the ranges
        and len(np.unique(facts.ids)) == len(facts.ids)
    )
    if not comparable or not len(whole):
        return
    lower, upper = facts.corners[whole, 0], facts.corners[whole, 1]
    offsets, found = light_lists(facts.bounds[:, 0], facts.bounds[:, 1], lower, upper, reach)
    lit = np.repeat(whole, np.diff(offsets)), facts.ids[found]
    kept = np.isin(owner, whole)
    stale = _rows_that_differ(len(facts.boxes), lit, (owner[kept], facts.listed[kept]))
    if len(stale):
        yield facts.boxes.warning(
            int(stale[0]),
            "nightcity:windowLights",
            f"no longer fits the geometry, here and in {len(stale) - 1} more of {len(whole)}"
            " boxes; the export computes lists anew unless it is told --lists authored",
        )


def _rows_that_differ(count: int, *pairs: tuple[NDArray, NDArray]) -> NDArray[np.int64]:
    """Rows below ``count`` whose values, in any order, are not the same in two (row, value)s."""
    (row_a, value_a), (row_b, value_b) = (
        (row[order], value[order]) for row, value in pairs for order in [np.lexsort((value, row))]
    )
    size_a, size_b = (np.bincount(row, minlength=count) for row in (row_a, row_b))
    differ = size_a != size_b
    same_size_a, same_size_b = ~differ[row_a], ~differ[row_b]
    wrong = value_a[same_size_a] != value_b[same_size_b]
    differ[row_a[same_size_a][wrong]] = True
    return np.flatnonzero(differ)


def check_sources(facts: Facts) -> Iterator[Finding]:
    """The instancers that boxes name are there."""
    known = set(facts.windows.paths) if facts.far_sources else set()
    for box, targets in facts.far_sources:
        strange = next((target for target in targets if target not in known), None)
        if strange:
            message = f"{strange} is no instancer of windows; remove it"
            yield Finding("warning", box, "nightcity:windowLightSources", message)


def check_one_ground(facts: Facts) -> Iterator[Finding]:
    for row in range(1, len(facts.grounds)):
        yield facts.grounds.error(
            row,
            "apiSchemas",
            f"{facts.grounds.paths[0]} is the ground already; remove NightcityGroundAPI from one of"
            " them",
        )


def check_presence(facts: Facts) -> Iterator[Finding]:
    """Without windows, haze or a camera there is a picture, but hardly one that was meant."""
    for missing, message in (
        (
            not len(facts.windows) and not facts.lights,
            "there are no windows: apply NightcityWindowsAPI to a PointInstancer",
        ),
        (not len(facts.boxes), "there is no haze: apply NightcityMediaAPI to a Cube"),
        (not facts.cameras, "there is no camera to render from: add a Camera"),
    ):
        if missing:
            yield Finding("warning", "", "", message)
