# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Overlapping boxes are found, touching ones are not, and large grids are quick."""

from __future__ import annotations

import time

import numpy as np
import pytest

from nightcity.box_overlaps import box_overlaps


def grid(columns: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
    index = np.indices((columns, rows)).reshape(2, -1).T.astype(float)
    lo = np.column_stack([10 * index, np.zeros(len(index))])
    return lo, lo + [10, 10, 30]


@pytest.mark.parametrize("seed", range(20))
def test_equals_comparing_every_pair(seed: int) -> None:
    rng = np.random.default_rng(seed)
    lo = rng.integers(0, 12, (60, 3)).astype(float)
    hi = lo + rng.integers(1, 4, (60, 3))
    meet = ((lo[:, None] < hi[None]) & (lo[None] < hi[:, None])).all(axis=2)
    every = np.argwhere(np.triu(meet, 1))
    assert len(every) > 0
    assert np.array_equal(box_overlaps(lo, hi, 10_000), every)


def test_shared_faces_edges_and_corners_are_no_overlap() -> None:
    assert len(box_overlaps(*grid(7, 5), 10)) == 0


def test_a_box_within_another_and_a_box_twice_are_overlaps() -> None:
    lo = np.array([[0, 0, 0], [1, 1, 1], [20, 0, 0], [20, 0, 0]], float)
    hi = np.array([[9, 9, 9], [2, 2, 2], [21, 1, 1], [21, 1, 1]], float)
    assert box_overlaps(lo, hi, 10).tolist() == [[0, 1], [2, 3]]


def test_no_more_than_asked_for() -> None:
    lo = np.zeros((100, 3))
    assert len(box_overlaps(lo, lo + 1, 7)) == 7


def test_none_and_one() -> None:
    assert box_overlaps(np.empty((0, 3)), np.empty((0, 3)), 5).shape == (0, 2)
    assert box_overlaps(np.zeros((1, 3)), np.ones((1, 3)), 5).shape == (0, 2)


def test_forty_thousand_boxes_in_seconds() -> None:
    lo, hi = grid(200, 200)
    hi[12_345] += 0.5
    start = time.process_time()
    assert box_overlaps(lo, hi, 10).tolist() == [[12345, 12346], [12345, 12545], [12345, 12546]]
    assert time.process_time() - start < 10
