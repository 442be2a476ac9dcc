# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Haze for the streets of a town: a regular grid of media boxes.

A box stands on the ground in every cell that has a building in it or in one of the eight cells
around it, as high as the tallest of those. Cells with no building that near are left out: no
window would light them, and a flat sheet of haze over open fields would only dim the ground.
Boxes contain buildings, which win over them.
"""

from __future__ import annotations

import numpy as np
import shapely

from nightcity.city.model import FloatArray, IntArray, MediaBox
from nightcity.city.street_grid import REACH_SCALE
from nightcity.city.town_options import TownOptions


def street_media(corners: FloatArray, options: TownOptions) -> tuple[MediaBox, ...]:
    """Media boxes, numbered row by row, around the triangles (T, 3, 3) m of all buildings.

    The edges of all cells are the same doubles, so boxes share faces bit by bit.
    """
    cells, heights = _built_cells(corners, options.cell_size)
    cells, heights = _with_neighbours(cells, heights)
    lo = np.column_stack([cells * options.cell_size, np.zeros(len(cells))])
    hi = np.column_stack([(cells + 1) * options.cell_size, heights])
    return tuple(
        MediaBox(number, lo[number], hi[number], options.extinction, options.albedo, REACH_SCALE)
        for number in range(len(cells))
    )


def _built_cells(corners: FloatArray, size: float) -> tuple[IntArray, FloatArray]:
    """The cells (N, 2), column and row, that triangles touch in plan, and their tops (N,) m.

    Cell (i, j) spans i to i + 1 and j to j + 1 cell sizes.
    """
    plan = corners[:, :, :2]
    first = np.floor(plan.min(axis=1) / size).astype(np.int64)
    last = np.floor(plan.max(axis=1) / size).astype(np.int64)
    spans = last - first + 1
    counts = spans.prod(axis=1)
    triangle = np.repeat(np.arange(len(corners)), counts)
    place = np.arange(len(triangle)) - np.repeat(np.cumsum(counts) - counts, counts)
    cells = first[triangle] + np.column_stack(
        [place % spans[triangle, 0], place // spans[triangle, 0]]
    )
    several = counts[triangle] > 1  # in a bounding rectangle of cells, not all are touched
    shapes = shapely.convex_hull(shapely.multipoints(plan))  # a line for a wall
    squares = shapely.box(*(cells * size).T, *((cells + 1) * size).T)
    touched = ~several
    touched[several] = shapely.intersects(shapes[triangle[several]], squares[several])
    return _highest(cells[touched], corners[triangle[touched], :, 2].max(axis=1))


def _with_neighbours(cells: IntArray, heights: FloatArray) -> tuple[IntArray, FloatArray]:
    """The cells and the eight around each, with the greatest of the heights that meet there."""
    around = np.array([(i, j) for j in (-1, 0, 1) for i in (-1, 0, 1)])
    return _highest((cells[:, None] + around).reshape(-1, 2), np.repeat(heights, len(around)))


def _highest(cells: IntArray, heights: FloatArray) -> tuple[IntArray, FloatArray]:
    """Each cell once, row by row, with its greatest height."""
    rows, inverse = np.unique(cells[:, ::-1], axis=0, return_inverse=True)
    highest = np.zeros(len(rows))
    np.maximum.at(highest, inverse.ravel(), heights)
    return rows[:, ::-1], highest
