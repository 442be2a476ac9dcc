# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The grid of cells that a generated city stands on, and the haze that fills its streets.

Columns and rows of cells alternate: street, building, street, ... street. A building stands where
both indices are odd, haze everywhere else. The city is centred on the origin.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nightcity.city.model import FloatArray, MediaBox
from nightcity.city.parameters import CityParameters

REACH_SCALE = 1.2  # Brito, Real-time Night City Rendering
CORNER_REACH_SCALE = 1.5  # of boxes at crossings, which face no window


@dataclass(frozen=True)
class StreetGrid:
    """Cell (column i, row j) spans x[i] to x[i + 1] and y[j] to y[j + 1], m."""

    x: FloatArray
    y: FloatArray

    def building_centres(self) -> FloatArray:
        """(rows, columns, 2) m."""
        x = 0.5 * (self.x[1:-1:2] + self.x[2::2])
        y = 0.5 * (self.y[1:-1:2] + self.y[2::2])
        return np.stack(np.meshgrid(x, y), axis=-1)


def street_grid(parameters: CityParameters) -> StreetGrid:
    """The grid of these parameters."""
    return StreetGrid(*(_edges(parameters, count) for count in parameters.grid))


def _edges(parameters: CityParameters, buildings: int) -> FloatArray:
    widths = np.full(2 * buildings + 1, parameters.street_width)
    widths[1::2] = parameters.building_base
    edges = np.concatenate(([0.0], np.cumsum(widths)))
    return edges - 0.5 * edges[-1]


def box_tops(heights: FloatArray) -> FloatArray:
    """Height of every cell, (2 rows + 1, 2 columns + 1) m: of its building, or of the tallest
    building among the eight cells around it."""
    rows, columns = heights.shape
    cells = np.zeros((2 * rows + 3, 2 * columns + 3))
    cells[2:-1:2, 2:-1:2] = heights
    shifted = [
        cells[j : j + 2 * rows + 1, i : i + 2 * columns + 1] for j in range(3) for i in range(3)
    ]
    return np.where(_is_building(rows, columns), cells[1:-1, 1:-1], np.max(shifted, axis=0))


def media_boxes(
    parameters: CityParameters, grid: StreetGrid, heights: FloatArray
) -> tuple[MediaBox, ...]:
    """Haze boxes, numbered row by row: those of the streets, then those of the haze layer.

    heights: (rows, columns) m. The layer, where there is one, continues every cell from the top
    of its building or street box to the layer's own top, so boxes meet and never overlap.
    """
    rows, columns = heights.shape
    tops = box_tops(heights)
    streets = np.argwhere(~_is_building(rows, columns))
    corners = (streets % 2 == 0).all(axis=1)
    lo, hi = _cell_boxes(grid, streets, 0.0, tops)
    reach = np.where(corners, CORNER_REACH_SCALE, REACH_SCALE)
    boxes = _boxes(0, lo, hi, parameters.extinction, parameters.albedo, reach)
    if parameters.haze_layer_thickness > 0:
        top = heights.max() + parameters.haze_layer_thickness
        lo, hi = _cell_boxes(grid, np.argwhere(np.ones_like(tops)), tops, np.full_like(tops, top))
        reach = np.full(len(lo), REACH_SCALE)
        extinction, albedo = parameters.haze_layer_extinction, parameters.haze_layer_albedo
        boxes += _boxes(len(boxes), lo, hi, extinction, albedo, reach)
    return tuple(boxes)


def _is_building(rows: int, columns: int) -> np.ndarray:
    return (np.arange(2 * rows + 1)[:, None] % 2 == 1) & (np.arange(2 * columns + 1) % 2 == 1)


def _cell_boxes(
    grid: StreetGrid, cells: np.ndarray, bottom: FloatArray | float, top: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Corners (N, 3) m of the boxes over cells (N, 2), each (row, column)."""
    j, i = cells.T
    bottom = np.broadcast_to(bottom, top.shape)
    lo = np.column_stack([grid.x[i], grid.y[j], bottom[j, i]])
    hi = np.column_stack([grid.x[i + 1], grid.y[j + 1], top[j, i]])
    return lo, hi


def _boxes(
    first_id: int,
    lo: FloatArray,
    hi: FloatArray,
    extinction: float,
    albedo: float,
    reach: FloatArray,
) -> list[MediaBox]:
    lo.setflags(write=False)
    hi.setflags(write=False)
    return [
        MediaBox(first_id + n, lo[n], hi[n], extinction, albedo, float(reach[n]))
        for n in range(len(lo))
    ]
