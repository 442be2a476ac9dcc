# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Windows on the four faces of generated buildings, and the billboard.

Order within a building: faces south (-y), east (+x), north (+y), west (-x); on a face rows from the
bottom up; in a row from left to right as seen from outside. A billboard comes last. Window ids run
through the buildings in their order.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nightcity.city.heights import BuildingShapes
from nightcity.city.model import BoolArray, FloatArray, Windows
from nightcity.city.parameters import CityParameters
from nightcity.city.seeds import Purpose, generator
from nightcity.city.window_colours import draw_colours
from nightcity.errors import UsageError

# Along the face, left to right as seen from outside; with z it spans the face, outward.
_ALONG = np.array([(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)], dtype=float)
_OUTWARD = np.array([(0, -1, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0)], dtype=float)
_UP = np.array((0.0, 0.0, 1.0))
_SOUTH = 0
_BILLBOARD_BELOW_ROOF = 3.0  # m, less where the building is too low for it


@dataclass(frozen=True)
class PaneLayout:
    """The panes of one building about its origin, all read-only.

    centres, half_u, half_v: (N, 3) m. power: (N,) W. panel: (N,) whether it is the billboard.
    """

    centres: FloatArray
    half_u: FloatArray
    half_v: FloatArray
    power: FloatArray
    panel: BoolArray

    def __post_init__(self) -> None:
        for array in (self.centres, self.half_u, self.half_v, self.power, self.panel):
            array.setflags(write=False)

    def __len__(self) -> int:
        return len(self.power)


def city_windows(parameters: CityParameters, shapes: BuildingShapes) -> list[Windows]:
    """The windows of every building, row by row of the city."""
    layouts = _layouts(parameters, shapes)
    starts = np.concatenate(([0], np.cumsum([len(layout) for layout in layouts])))
    total = int(starts[-1])
    panel = np.concatenate([layout.panel for layout in layouts])
    light_on = generator(parameters.seed, Purpose.LIT).random(total) < parameters.lit
    light_on |= panel
    rng = generator(parameters.seed, Purpose.COLOURS)
    colours = draw_colours(parameters.window_colours, total, rng)
    colours[panel] = parameters.window_colours[0][:3]
    ids = np.arange(total)
    for array in (light_on, colours, ids):
        array.setflags(write=False)
    windows = []
    for layout, start in zip(layouts, starts[:-1], strict=True):
        own = slice(start, start + len(layout))
        windows.append(
            Windows(
                layout.centres,
                layout.half_u,
                layout.half_v,
                layout.power,
                colours[own],
                light_on[own],
                ids[own],
            )
        )
    return windows


def billboard_building(parameters: CityParameters) -> tuple[int, int]:
    """(row, column) of the building with the billboard: at the southern edge, east of the street
    that runs nearest to the centre. It hangs on the south face."""
    return 0, parameters.grid[0] // 2


def _layouts(parameters: CityParameters, shapes: BuildingShapes) -> list[PaneLayout]:
    """One a building; buildings of one shape share theirs."""
    known: dict[tuple[float, int], PaneLayout] = {}
    layouts = []
    for height, rows in zip(shapes.heights.flat, shapes.window_rows.flat, strict=True):
        shape = float(height), int(rows)
        if shape not in known:
            known[shape] = _window_layout(parameters, *shape)
        layouts.append(known[shape])
    if parameters.billboard_power > 0:
        row, column = billboard_building(parameters)
        index = row * parameters.grid[0] + column
        height = float(shapes.heights[row, column])
        layouts[index] = _with_billboard(parameters, layouts[index], height)
    return layouts


def _window_layout(parameters: CityParameters, height: float, rows: int) -> PaneLayout:
    """Windows centred on the interior vertices of a (across + 1) x (rows + 1) grid on each face."""
    across, base = parameters.windows_across, parameters.building_base
    along = base * np.arange(1, across + 1) / (across + 1) - 0.5 * base
    z = height * np.arange(1, rows + 1) / (rows + 1)
    out = (0.5 * base + parameters.window_offset) * _OUTWARD
    centres = (
        out[:, None, None] + along[:, None] * _ALONG[:, None, None] + z[:, None, None] * _UP
    )  # (4 faces, rows, across, 3)
    count = centres.size // 3
    half_u = np.repeat(0.5 * parameters.window_width * _ALONG, rows * across, axis=0)
    half_v = np.tile(0.5 * parameters.window_height * _UP, (count, 1))
    power = np.full(count, parameters.window_power)
    panel = np.zeros(count, dtype=bool)
    # + 0.0 turns negative zeros into zeros
    return PaneLayout(centres.reshape(-1, 3) + 0.0, half_u + 0.0, half_v, power, panel)


def _with_billboard(parameters: CityParameters, layout: PaneLayout, height: float) -> PaneLayout:
    """The layout with the panel on the south face, without the windows that it would cover."""
    room = height - parameters.billboard_height
    if room < 0:
        raise UsageError(
            f"billboard_height: {parameters.billboard_height:g} m is more than the building of "
            f"{height:g} m that it hangs on; lower it"
        )
    centre = (0.5 * parameters.building_base + parameters.window_offset) * _OUTWARD[_SOUTH]
    top = height - min(_BILLBOARD_BELOW_ROOF, 0.5 * room)
    centre = centre + (top - 0.5 * parameters.billboard_height) * _UP
    half_u = 0.5 * parameters.billboard_width * _ALONG[_SOUTH]
    half_v = 0.5 * parameters.billboard_height * _UP
    reach = layout.half_u + layout.half_v + half_u + half_v
    in_front = layout.half_u[:, 0] > 0  # the south face's windows run along +x
    gap = np.abs(layout.centres - centre)
    covered = in_front & (gap[:, 0] < reach[:, 0]) & (gap[:, 2] < reach[:, 2])
    return PaneLayout(
        np.vstack([layout.centres[~covered], centre + 0.0]),
        np.vstack([layout.half_u[~covered], half_u]),
        np.vstack([layout.half_v[~covered], half_v]),
        np.append(layout.power[~covered], parameters.billboard_power),
        np.append(layout.panel[~covered], True),
    )
