# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Light lists against a twin that tests every window against every box."""

from __future__ import annotations

import tracemalloc
from itertools import pairwise

import numpy as np
import pytest

from nightcity import light_lists as module
from nightcity.light_lists import TOUCH_TOLERANCE, light_lists, window_bounds


def every_pair(window_lo, window_hi, box_lo, box_hi, reach_scale):
    """The rule as the paper states it: scale both boxes about their centres, compare."""
    lists = []
    for lo, hi, scale in zip(box_lo, box_hi, reach_scale, strict=True):
        box_centre, box_half = (lo + hi) / 2, (hi - lo) / 2 * scale
        found = []
        for index, (low, high) in enumerate(zip(window_lo, window_hi, strict=True)):
            centre, half = (low + high) / 2, (high - low) / 2 * 1.3
            gap = np.maximum(
                (centre - half) - (box_centre + box_half), (box_centre - box_half) - (centre + half)
            )
            if (gap <= TOUCH_TOLERANCE).all():
                found.append(index)
        lists.append(found)
    return lists


def as_lists(offsets, indices):
    return [indices[a:b].tolist() for a, b in pairwise(offsets)]


def random_boxes(rng, count, spread, smallest, largest):
    centre = rng.uniform(-spread, spread, (count, 3))
    half = np.exp(rng.uniform(np.log(smallest), np.log(largest), (count, 3)))
    return centre - half, centre + half


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("block", [1, 7, 1 << 20])
def test_equals_every_pair(monkeypatch, seed, block):
    monkeypatch.setattr(module, "_BLOCK", block)
    rng = np.random.default_rng(seed)
    windows = random_boxes(rng, 150, 20, 0.01, [1, 30, 2][seed % 3])
    boxes = random_boxes(rng, 40, 30, 0.5, [5, 5, 80][seed % 3])
    reach = rng.uniform(0.5, 2, 40)
    expected = every_pair(*windows, *boxes, reach)
    assert as_lists(*light_lists(*windows, *boxes, reach)) == expected
    assert any(expected) and not all(len(found) == 150 for found in expected)


def test_touching_counts_and_a_gap_does_not():
    box_lo, box_hi = np.array([[0.0, 0, 0]]), np.array([[10.0, 10, 30]])  # reaches x = 11
    half = np.array([0.5, 0.5, 0.5])

    def listed(x):
        centre = np.array([[x, 5.0, 15.0]])
        return len(light_lists(centre - half, centre + half, box_lo, box_hi, 1.2)[1])

    assert listed(11.65) == 1  # 11 + 1.3 x 0.5
    assert listed(11.65 + 0.9 * TOUCH_TOLERANCE) == 1
    assert listed(11.65 + 1.5 * TOUCH_TOLERANCE) == 0


def test_a_distant_window_and_a_box_that_holds_all():
    rng = np.random.default_rng(3)
    lo, hi = random_boxes(rng, 60, 30, 0.1, 1)
    lo[7] += 1e9
    hi[7] += 1e9
    boxes = (
        np.array([[-40.0] * 3, [-1e12] * 3, [5e11] * 3]),
        np.array([[40.0] * 3, [1e12] * 3, [6e11] * 3]),
    )
    offsets, indices = light_lists(lo, hi, *boxes, 1.2)
    assert offsets.tolist() == [0, 59, 119, 119]
    assert 7 not in indices[:59] and indices[59:].tolist() == list(range(60))


@pytest.mark.parametrize("windows, boxes", [(0, 0), (0, 3), (4, 0)])
def test_empty(windows, boxes):
    w, b = np.zeros((windows, 3)), np.zeros((boxes, 3))
    offsets, indices = light_lists(w, w + 1, b + 50, b + 51, 1.2)
    assert offsets.tolist() == [0] * (boxes + 1) and len(indices) == 0
    assert offsets.dtype == indices.dtype == np.int64


@pytest.mark.parametrize(
    "change, message",
    [
        (lambda a: a[0].__setitem__((1, 2), np.nan), "window_lo and window_hi must be finite"),
        (lambda a: a[1].__setitem__((1, 2), np.inf), "window_lo and window_hi must be finite"),
        (lambda a: a[2].__setitem__((0, 0), 9), "box_lo and box_hi must be finite, with lo <= hi"),
        (lambda a: a[4].__setitem__(0, -1), "reach_scale"),
        (lambda a: a.__setitem__(0, a[0][:, :2]), "window_lo and window_hi must both be"),
        (lambda a: a.__setitem__(1, a[1][:-1]), "window_lo and window_hi must both be"),
    ],
)
def test_refuses(change, message):
    arguments = [np.zeros((4, 3)), np.ones((4, 3)), np.zeros((2, 3)), np.ones((2, 3)), np.ones(2)]
    change(arguments)
    with pytest.raises(ValueError, match=message):
        light_lists(*arguments)


def test_bounds_of_a_turned_rectangle():
    lo, hi = window_bounds([[1, 2, 3]], [[0.3, -0.4, 0]], [[0, 0, 0.7]])
    np.testing.assert_allclose(lo, [[0.7, 1.6, 2.3]])
    np.testing.assert_allclose(hi, [[1.3, 2.4, 3.7]])


def test_memory_follows_the_result():
    """200,000 windows in one column under 60 boxes: 12 million candidates, few that touch."""
    rng = np.random.default_rng(1)
    centre = np.column_stack([np.zeros((200_000, 2)), rng.uniform(0, 1e5, 200_000)])
    boxes = np.column_stack([np.zeros((60, 2)), np.arange(60) * 300.0])
    tracemalloc.start()
    offsets, _ = light_lists(centre - 0.1, centre + 0.1, boxes, boxes + 1, 1.2)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert offsets[-1] > 0 and peak < 400e6
