# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Rays and cover among a few boxes whose answers are known."""

from __future__ import annotations

import numpy as np
import pytest
from town_files import box

from nightcity.city.free_space import FreeSpace
from nightcity.city.model import FloatArray


def corners_of(*boxes: tuple[tuple, tuple]) -> FloatArray:
    """Triangles of boxes, each (lo, hi)."""
    quads = [face[0] for lo, hi in boxes for face in box(lo, hi)]
    return np.array([[q[0], q[i], q[i + 1]] for q in quads for i in (1, 2)], dtype=float)


def test_distance_to_the_first_wall() -> None:
    space = FreeSpace(corners_of(((10, -5, 0), (12, 5, 8)), ((20, -5, 0), (22, 5, 8))))
    origins = np.array([(0, 0, 1), (0, 0, 9), (15, 0, 1), (15, 0, 1), (0, 5.1, 1)], dtype=float)
    directions = np.array([(1, 0, 0), (1, 0, 0), (1, 0, 0), (-1, 0, 0), (1, 0, 0)], dtype=float)
    assert space.distances(origins, directions, 50).tolist() == [10, np.inf, 5, 3, np.inf]
    assert space.distances(origins[:1], directions[:1], 9.9).tolist() == [np.inf]


def test_no_ray_slips_through_a_diagonal() -> None:
    space = FreeSpace(corners_of(((10, -5, 0), (12, 5, 10))))
    y = np.linspace(-4.9, 4.9, 99)
    origins = np.column_stack((np.zeros(99), y, y + 5))  # the wall's own diagonal
    assert (space.distances(origins, np.tile((1.0, 0, 0), (99, 1)), 50) == 10).all()


@pytest.mark.parametrize(
    "boxes, point, inside",
    [
        ([((0, 0, 0), (9, 9, 9))], (4.1, 4.3, 1), True),
        ([((0, 0, 0), (9, 9, 9))], (4.1, 4.3, 9.1), False),
        ([((0, 0, 0), (9, 9, 9))], (9.1, 4.3, 1), False),
        ([((0, 0, 5), (9, 9, 9))], (4.1, 4.3, 1), False),  # under an arch
        ([((0, 0, 0), (9, 9, 9)), ((2, 2, 4), (6, 6, 5))], (4.1, 4.3, 1), True),  # one in another
        ([((0, 0, 0), (9, 9, 5)), ((0, 0, 5), (9, 9, 9))], (4.1, 4.3, 1), True),  # one on another
        ([((0, 0, 0), (9, 9, 9)), ((2, 2, 4), (6, 6, 15))], (4.1, 4.3, 8), True),  # overlapping
    ],
)
def test_covered(boxes: list, point: tuple[float, ...], inside: bool) -> None:
    assert FreeSpace(corners_of(*boxes)).covered(np.array([point])).tolist() == [inside]


def test_more_rays_than_one_block_holds() -> None:
    space = FreeSpace(corners_of(((10, -5, 0), (12, 5, 8))))
    origins = np.tile((0.0, 0.2, 1.0), (45_000, 1))
    origins[::2, 2] = 9.0
    distance = space.distances(origins, np.tile((1.0, 0, 0), (45_000, 1)), 50)
    assert (distance[::2] == np.inf).all() and (distance[1::2] == 10).all()
