# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Which windows light which media box, by the paper's bounding-box rule.

A window belongs to a box if the window's bounding box, scaled by 1.3 about its centre, touches the
media box, scaled by 1.2 (corner boxes by 1.5) about its centre. Intervals are closed.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike, NDArray

WINDOW_SCALE = 1.3  # Brito, Real-time Night City Rendering
# Gaps below this count as touching, so that positions rounded to float32 (3e-5 m at 1 km) give
# the list of the double-precision ones.
TOUCH_TOLERANCE = 1e-3  # m
_BLOCK = 1 << 20  # candidates at a time; bounds the memory beside the result
_WINDOWS = 1 << 18  # windows at a time, for the same end

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def window_bounds(
    centres: ArrayLike, half_u: ArrayLike, half_v: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Lower and upper corners, (N, 3) m each, of the boxes that bound N rectangles.

    centres, half_u, half_v: (N, 3) m, all in the frame of the media boxes.
    """
    centres = np.asarray(centres, dtype=np.float64)
    reach = np.abs(half_u) + np.abs(half_v)
    return centres - reach, centres + reach


def light_lists(
    window_lo: ArrayLike,
    window_hi: ArrayLike,
    box_lo: ArrayLike,
    box_hi: ArrayLike,
    reach_scale: ArrayLike,
) -> tuple[IntArray, IntArray]:
    """The windows that light each media box.

    window_lo, window_hi: (N, 3) m. box_lo, box_hi: (M, 3) m. reach_scale: (M,) or one for all.
    Returns offsets (M + 1,) and indices: box i holds ``indices[offsets[i]:offsets[i + 1]]``,
    ascending indices into the windows. ValueError if shapes differ, or a value is not finite.

    Work grows with the windows near each box: windows lie in columns of a grid, of which only the
    occupied ones are stored.
    """
    window_lo, window_hi = _corners(window_lo, window_hi, "window")
    boxes = _centres_and_halves(*_corners(box_lo, box_hi, "box"))
    scale = np.broadcast_to(np.asarray(reach_scale, dtype=np.float64), (len(boxes[0]),))
    if not np.isfinite(scale).all() or (scale < 0).any():
        raise ValueError("reach_scale must be finite and not negative")
    boxes = boxes[0], boxes[1] * scale[:, None] + TOUCH_TOLERANCE
    found = [(np.empty(0, np.int64), np.empty(0, np.int64))]
    for start in range(0, len(window_lo), _WINDOWS):
        block = slice(start, start + _WINDOWS)
        box, window = _block_pairs(window_lo[block], window_hi[block], boxes)
        found.append((box, window + start))
    box, window = (np.concatenate(parts) for parts in zip(*found, strict=True))
    # Within a block pairs ascend by window: a stable sort keeps that within each box.
    order = np.argsort(box, kind="stable")
    counts = np.bincount(box, minlength=len(boxes[0]))
    return np.concatenate(([0], np.cumsum(counts))).astype(np.int64), window[order]


def _corners(lo: ArrayLike, hi: ArrayLike, name: str) -> tuple[FloatArray, FloatArray]:
    lo, hi = np.asarray(lo, dtype=np.float64), np.asarray(hi, dtype=np.float64)
    if lo.size == 0 and hi.size == 0:
        return np.empty((0, 3)), np.empty((0, 3))
    if lo.ndim != 2 or lo.shape[1] != 3 or lo.shape != hi.shape:
        raise ValueError(
            f"{name}_lo and {name}_hi must both be (count, 3), not {lo.shape} and {hi.shape}"
        )
    if not (np.isfinite(lo).all() and np.isfinite(hi).all()) or (lo > hi).any():
        raise ValueError(f"{name}_lo and {name}_hi must be finite, with lo <= hi")
    return lo, hi


def _centres_and_halves(lo: FloatArray, hi: FloatArray) -> tuple[FloatArray, FloatArray]:
    return 0.5 * (lo + hi), 0.5 * (hi - lo)


def _block_pairs(
    lo: FloatArray, hi: FloatArray, boxes: tuple[FloatArray, FloatArray]
) -> tuple[IntArray, IntArray]:
    """All (box, window) that touch, by box, then window."""
    centre, half = _centres_and_halves(lo, hi)
    windows = centre, half * WINDOW_SCALE
    low, high = (centre - windows[1]).min(axis=0), (centre + windows[1]).max(axis=0)
    near = np.flatnonzero(
        ((boxes[0] - boxes[1] <= high) & (boxes[0] + boxes[1] >= low)).all(axis=1)
    )
    boxes = boxes[0][near], boxes[1][near]
    pairs = [_touching_pairs(members, windows, boxes) for members in _size_classes(windows[1])]
    box, window = (np.concatenate(parts) for parts in zip(*pairs, strict=True))
    order = np.lexsort((window, box))
    return near[box[order]], window[order]


def _size_classes(halves: FloatArray) -> Iterator[IntArray]:
    """Groups the windows by horizontal extent, factors of 4 apart: one billboard among a million
    panes must not widen the search for all of them."""
    size = np.floor(0.5 * np.log2(np.maximum(halves[:, :2].max(axis=1, initial=0.0), 1e-3)))
    for value in np.unique(size):
        yield np.flatnonzero(size == value)


def _touching_pairs(
    members: IntArray,
    windows: tuple[FloatArray, FloatArray],
    boxes: tuple[FloatArray, FloatArray],
) -> tuple[IntArray, IntArray]:
    """All (box, window) that touch, of the windows ``members``, which are alike in size."""
    found_box, found_window = [np.empty(0, np.int64)], [np.empty(0, np.int64)]
    for box, window in _candidates(members, windows, boxes):
        gap = np.abs(windows[0][window] - boxes[0][box]) - windows[1][window] - boxes[1][box]
        touching = (gap <= 0).all(axis=1)
        found_box.append(box[touching])
        found_window.append(window[touching])
    return np.concatenate(found_box), np.concatenate(found_window)


def _candidates(
    members: IntArray,
    windows: tuple[FloatArray, FloatArray],
    boxes: tuple[FloatArray, FloatArray],
) -> Iterator[tuple[IntArray, IntArray]]:
    """Blocks of (box, window) that share a grid column: a superset of those that touch.

    Windows are sorted by column (x, then y), so the columns of one box are one run of windows for
    each x.
    """
    if len(members) == 0 or len(boxes[0]) == 0:
        return
    centre = windows[0][members, :2]
    reach = boxes[1][:, :2] + windows[1][members, :2].max(axis=0)
    origin, span = centre.min(axis=0), np.ptp(centre, axis=0)
    cell = max(float(np.median(reach)), float(span.max()) / 2**30, TOUCH_TOLERANCE)
    column = np.floor((centre - origin) / cell).astype(np.int64)
    columns_y = int(column[:, 1].max()) + 1
    last = column.max(axis=0)
    key = column[:, 0] * columns_y + column[:, 1]
    order = np.argsort(key, kind="stable")
    key, sorted_members = key[order], members[order]
    rows = np.unique(column[:, 0])

    low = np.floor((boxes[0][:, :2] - reach - origin) / cell)
    high = np.floor((boxes[0][:, :2] + reach - origin) / cell)
    low = np.clip(low, 0, last + 1).astype(np.int64)
    high = np.clip(high, -1, last).astype(np.int64)
    first_row = np.searchsorted(rows, low[:, 0], "left")
    row_count = np.maximum(np.searchsorted(rows, high[:, 0], "right") - first_row, 0)
    for part in _blocks(row_count):
        box = np.repeat(np.arange(part.start, part.stop), row_count[part])
        row = rows[_expand(first_row[part], row_count[part])] * columns_y
        start = np.searchsorted(key, row + low[box, 1], "left")
        count = np.maximum(np.searchsorted(key, row + high[box, 1], "right") - start, 0)
        for run in _blocks(count):
            yield np.repeat(box[run], count[run]), sorted_members[_expand(start[run], count[run])]


def _blocks(counts: IntArray) -> Iterator[slice]:
    """Slices of ``counts`` that each add up to at most _BLOCK, or hold one entry."""
    total = np.concatenate(([0], np.cumsum(counts)))
    start = 0
    while start < len(counts):
        stop = int(np.searchsorted(total, total[start] + _BLOCK, "right")) - 1
        stop = max(stop, start + 1)
        yield slice(start, stop)
        start = stop


def _expand(starts: IntArray, counts: IntArray) -> IntArray:
    """starts[0], starts[0] + 1, ... (counts[0] of them), starts[1], ... as one array."""
    ends = np.cumsum(counts)
    total = int(ends[-1]) if len(ends) else 0
    return np.repeat(starts - ends + counts, counts) + np.arange(total)
