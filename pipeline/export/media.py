# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Media boxes: cubes with NightcityMediaAPI, as axis-aligned boxes in metres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from nightcity.box_overlaps import box_overlaps
from nightcity.errors import SceneError
from nightcity.export.findings import Item
from nightcity.export.notes import Notes
from nightcity.export.open_stage import Source
from nightcity.progress import Progress

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# m. Faces closer than this are one face: the renderer wants those that touch equal to the bit.
SNAP = 1e-4
_NUMBERS = ("size", "nightcity:extinction", "nightcity:albedo", "nightcity:reachScale")


@dataclass
class Media:
    """One row a box; one entry a window that a stage lists for a box.

    lo, hi: (M, 3) m, on the stage. extinction: (M,) 1/m. albedo: (M,). reach_scale: (M,).
    id: (M,). owner: (M,) into paths. first_copy: (M,) whether the row is the prim itself rather
    than a further instance of it. paths: of the prims. source_paths: those that every native
    instance of the same prim shares. listed_box, listed_id: (L,) ``windowLights``, by row.
    stated: (M,) whether that is authored.
    """

    lo: FloatArray
    hi: FloatArray
    extinction: FloatArray
    albedo: FloatArray
    reach_scale: FloatArray
    id: IntArray
    owner: IntArray
    first_copy: NDArray[np.bool_]
    listed_box: IntArray
    listed_id: IntArray
    stated: NDArray[np.bool_]
    paths: list[str]
    source_paths: list[str]

    def __len__(self) -> int:
        return len(self.id)

    def path(self, row: int) -> str:
        return self.paths[self.owner[row]]


_ROWS = tuple(
    f.name
    for f in fields(Media)
    if f.name not in ("listed_box", "listed_id", "paths", "source_paths")
)


def read_media(source: Source, items: Sequence[Item]) -> Media:
    """Every media box, where it stands on the stage.

    Raises SceneError naming the prim of a box that is rotated, flat or out of range.
    """
    numbers = np.empty((len(items), len(_NUMBERS)))
    ids = np.empty(len(items), dtype=np.int64)
    stated, lists = np.zeros(len(items), dtype=bool), []
    with Progress("reading media boxes", len(items)) as progress:
        for row, item in enumerate(items):
            numbers[row] = [source.value(item.prim, name) for name in _NUMBERS]
            ids[row] = source.value(item.prim, "nightcity:mediaId")
            listed = item.prim.GetAttribute("nightcity:windowLights")
            values, stated[row] = listed.Get(), listed.HasAuthoredValue()
            lists.append(np.array(values if values is not None else [], dtype=np.int64))
            progress.advance()
    copies = np.array([len(item.matrices) for item in items], dtype=np.int64)
    owner = np.repeat(np.arange(len(items)), copies)
    size, extinction, albedo, reach_scale = numbers[owner].T
    matrices = np.concatenate([np.empty((0, 4, 4)), *(item.matrices for item in items)])
    first_copy = np.zeros(len(owner), dtype=bool)
    if len(owner):
        first_copy[np.cumsum(copies) - copies] = True
    lengths = [len(lists[index]) for index in owner]
    media = Media(
        np.empty((len(owner), 3)), np.empty((len(owner), 3)),
        extinction, albedo, reach_scale, ids[owner], owner, first_copy,
        np.repeat(np.arange(len(owner)), lengths),
        np.concatenate([np.empty(0, np.int64), *(lists[index] for index in owner)]),
        stated[owner],
        [str(item.prim.GetPath()) for item in items],
        [item.source_path for item in items],
    )  # fmt: skip
    _check_values(media)
    media.lo, media.hi = _corners(media, matrices, size)
    return media


def joined_media(parts: Sequence[Media]) -> Media:
    """The boxes of all parts, one part after the other."""
    columns = {name: np.concatenate([getattr(part, name) for part in parts]) for name in _ROWS}
    rows = np.cumsum([0] + [len(part) for part in parts])
    prims = np.cumsum([0] + [len(part.paths) for part in parts])
    columns["owner"] = columns["owner"] + np.repeat(prims[:-1], np.diff(rows))
    return Media(
        **columns,
        listed_box=np.concatenate(
            [p.listed_box + r for p, r in zip(parts, rows[:-1], strict=True)]
        ),
        listed_id=np.concatenate([part.listed_id for part in parts]),
        paths=[path for part in parts for path in part.paths],
        source_paths=[path for part in parts for path in part.source_paths],
    )


def settle_media(media: Media, notes: Notes, ground: float | None = None) -> None:
    """Make faces that touch equal, number the copies, and refuse boxes that overlap.

    A box that stands on the ground, at height ``ground`` (m), starts there to the bit, as the
    renderer expects. Raises SceneError naming two boxes that have one number or overlap.
    """
    media.lo, media.hi = snapped(media.lo, media.hi)
    if ground is not None:
        for corners in (media.lo, media.hi):
            corners[np.abs(corners[:, 2] - ground) < SNAP, 2] = ground
    _number(notes, media)
    _check_overlap(media)


def _check_values(media: Media) -> None:
    checks = (
        ("nightcity:extinction", media.extinction, 0.0, np.inf, "finite and 0 or more"),
        ("nightcity:albedo", media.albedo, 0.0, 1.0, "between 0 and 1"),
        ("nightcity:reachScale", media.reach_scale, 0.0, np.inf, "finite and above 0"),
        ("nightcity:mediaId", media.id, 0, np.inf, "0 or more"),
    )
    for name, values, least, most, wanted in checks:
        bad = ~(np.isfinite(values) & (values >= least) & (values <= most))
        if name == "nightcity:reachScale":
            bad |= values == 0
        if bad.any():
            row = int(np.argmax(bad))
            raise SceneError(f"{media.path(row)}.{name} is {values[row]}; it must be {wanted}")


def _corners(media: Media, matrices: FloatArray, size: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Lower and upper corners, (M, 3)."""
    edges = matrices[:, :3, :3] * size[:, None, None]  # rows: the box's three edges
    along = np.argmax(np.abs(edges), axis=2)
    longest = np.take_along_axis(np.abs(edges), along[:, :, None], axis=2)[:, :, 0]
    lean = (np.abs(edges).sum(axis=2) - longest).sum(axis=1)
    rotated = (np.sort(along, axis=1) != np.arange(3)).any(axis=1)
    rotated |= lean > SNAP + 1e-6 * longest.max(axis=1, initial=0.0)
    # A box without volume is named as such: its edges have no direction.
    flat = ~(longest > SNAP).all(axis=1) | ~np.isfinite(longest).all(axis=1)
    for bad, what in (
        (flat, f"has no volume: each edge must be finite and longer than {SNAP} m"),
        (rotated, "is rotated or sheared: a media box must lie along the world's axes"),
    ):
        if bad.any():
            raise SceneError(f"{media.path(int(np.argmax(bad)))}: the media box {what}")
    half = np.zeros((len(size), 3))
    np.put_along_axis(half, along, 0.5 * longest, axis=1)
    centre = matrices[:, 3, :3]
    return centre - half, centre + half


def snapped(lo: FloatArray, hi: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Corners (M, 3) with faces of one axis that differ by less than SNAP moved onto one plane:
    onto the one that most of them lie in, so that exact neighbours keep their place."""
    count, result = len(lo), np.concatenate([lo, hi])
    for axis in range(3):
        values, inverse, tally = np.unique(result[:, axis], return_inverse=True, return_counts=True)
        result[:, axis] = _plane_of(values, tally)[inverse]
    return result[:count], result[count:]


def _plane_of(values: FloatArray, tally: NDArray[np.int64]) -> FloatArray:
    """For each of the ascending values the one that its group shares. A group reaches SNAP from
    its lowest value at most, so that a chain of near values cannot drift."""
    planes = values.copy()
    close = np.flatnonzero(np.diff(values) < SNAP)
    done = -1
    for first in close.tolist():
        if first <= done:
            continue
        stop = int(np.searchsorted(values, values[first] + SNAP))
        done = stop - 1
        planes[first:stop] = values[first + int(np.argmax(tally[first:stop]))]
    return planes


def _number(notes: Notes, media: Media) -> None:
    """Instances get numbers of their own; two prims with one number are an error."""
    sources: dict[str, int] = {}
    for row in range(len(media)):
        path = media.source_paths[media.owner[row]]
        media.first_copy[row] &= sources.setdefault(path, row) == row
    fresh = np.flatnonzero(~media.first_copy)
    own = np.flatnonzero(media.first_copy)
    unique, tally = np.unique(media.id[own], return_counts=True)
    if (tally > 1).any():
        number = unique[np.argmax(tally > 1)]
        first, second = own[media.id[own] == number][:2]
        raise SceneError(
            f"{media.path(first)} and {media.path(second)}: both have nightcity:mediaId {number};"
            " give each media box a number of its own"
        )
    if len(fresh):
        start = int(media.id[own].max()) + 1
        new = np.arange(start, start + len(fresh))
        if start + len(fresh) > 2**31:
            new = np.setdiff1d(np.arange(len(media)), media.id[own])[: len(fresh)]
        media.id[fresh] = new
        for row in fresh:
            notes.about("Instances of a media box have got new mediaIds", media.path(row))


def _check_overlap(media: Media) -> None:
    pairs = box_overlaps(media.lo, media.hi, most=1)
    if len(pairs) == 0:
        return
    first, second = pairs[0]
    depth = np.minimum(media.hi[first], media.hi[second]) - np.maximum(
        media.lo[first], media.lo[second]
    )
    raise SceneError(
        f"{media.path(first)} and {media.path(second)}: these media boxes overlap by"
        f" {depth[0]:.6g} x {depth[1]:.6g} x {depth[2]:.6g} m; boxes may share faces, not space"
    )
