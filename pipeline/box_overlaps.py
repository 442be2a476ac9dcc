# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Which axis-aligned boxes overlap; boxes that only share faces, edges or corners do not."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

_BLOCK = 1 << 20  # candidate pairs at a time; bounds the memory


def box_overlaps(lo: ArrayLike, hi: ArrayLike, most: int) -> NDArray[np.int64]:
    """Pairs (K, 2) of boxes whose interiors meet, the smaller index first, at most ``most``.

    lo, hi: (N, 3), lower and upper corners, compared as they are: round both to float32 to judge
    boxes as the renderer does. Sweeps along the axis on which the fewest boxes lie side by side;
    work grows with the pairs that overlap on it.
    """
    lo, hi = np.asarray(lo), np.asarray(hi)
    order, counts = _best_axis(lo, hi)
    found: list[NDArray[np.int64]] = []
    total = 0
    ends = np.cumsum(counts)
    start = 0
    while start < len(counts) and total < most:
        before = ends[start] - counts[start]
        stop = max(int(np.searchsorted(ends, before + _BLOCK, "right")), start + 1)
        first = np.repeat(np.arange(start, stop), counts[start:stop])
        step = np.arange(len(first)) - np.repeat(
            ends[start:stop] - counts[start:stop] - before, counts[start:stop]
        )
        a, b = order[first], order[first + 1 + step]
        meet = ((lo[a] < hi[b]) & (lo[b] < hi[a])).all(axis=1)
        found.append(np.sort(np.column_stack([a[meet], b[meet]]), axis=1))
        total += len(found[-1])
        start = stop
    pairs = np.concatenate([*found, np.empty((0, 2), np.int64)])
    return pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))][:most]


def _best_axis(lo: NDArray, hi: NDArray) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The boxes in order of their lower corners on one axis, and how many of those that follow
    each box begin before it ends."""
    sweeps = []
    for axis in range(3):
        order = np.argsort(lo[:, axis], kind="stable")
        begin = np.searchsorted(lo[order, axis], hi[order, axis], "left")
        sweeps.append((order, np.maximum(begin - np.arange(1, len(order) + 1), 0)))
    return min(sweeps, key=lambda sweep: int(sweep[1].sum()))
