# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The cameras of a generated city: the paper's, and their like in other cities."""

from __future__ import annotations

import numpy as np

from nightcity.city.cameras import look_along, overview_cameras
from nightcity.city.facades import billboard_building
from nightcity.city.heights import BuildingShapes
from nightcity.city.model import Building, Camera, FloatArray
from nightcity.city.parameters import CityParameters
from nightcity.city.street_grid import StreetGrid, box_tops

_FOV = 60.0  # degrees, of the cameras that stand in a street
_CLOSE = 2.0  # m in front of a window


def grid_cameras(
    parameters: CityParameters,
    grid: StreetGrid,
    shapes: BuildingShapes,
    buildings: list[Building],
) -> tuple[Camera, ...]:
    """overview75 first, then overview25, 50, 100, far25, street, close, inside, and billboard
    where there is one."""
    lo = np.array((grid.x[0], grid.y[0], 0.0))
    hi = np.array((grid.x[-1], grid.y[-1], shapes.heights.max()))
    cameras = [
        *overview_cameras(lo, hi),
        _street(parameters, grid),
        _close(parameters, grid, buildings),
        _inside(parameters, grid, shapes),
    ]
    if parameters.billboard_power > 0:
        cameras.append(_billboard(parameters, grid, buildings))
    return tuple(cameras)


def _central_street(count: int) -> int:
    """Cell index of the street nearest to the middle of a row of ``count`` buildings, the lower
    of two."""
    return 2 * (count // 2)


def _street_centre(parameters: CityParameters, grid: StreetGrid) -> float:
    i = _central_street(parameters.grid[0])
    return 0.5 * float(grid.x[i] + grid.x[i + 1])


def _street(parameters: CityParameters, grid: StreetGrid) -> Camera:
    """At the southern end of the central street, looking up along it: (1.5, -38, 2) towards
    (0, 10, 14) in the paper's 4 x 4 city."""
    x, width = _street_centre(parameters, grid), parameters.street_width
    eye = (x + 0.15 * width, float(grid.y[0]) + 0.7 * width, 2.0)
    return Camera("street", eye, (x, eye[1] + 48.0, 14.0), _FOV)


def _close(parameters: CityParameters, grid: StreetGrid, buildings: list[Building]) -> Camera:
    """In front of the lit window nearest to 10 m up on the southern half of the central facade,
    looking along it."""
    columns, rows = parameters.grid
    building = buildings[(rows // 2) * columns + columns // 2]
    west_face = building.origin + (-0.5 * parameters.building_base, 0.0, 0.0)
    wanted = west_face + (0.0, -0.3 * parameters.building_base, 10.0)
    eye, along = _before_nearest_pane(parameters, building, wanted, _CLOSE)
    return look_along("close", eye, along, _FOV)


def _billboard(parameters: CityParameters, grid: StreetGrid, buildings: list[Building]) -> Camera:
    """In the street before the billboard, near its western edge, looking at its middle."""
    row, column = billboard_building(parameters)
    building = buildings[row * parameters.grid[0] + column]
    centre = building.origin + building.windows.centres[-1]
    half_width = 0.5 * parameters.billboard_width
    eye = centre + (-0.8 * half_width, -0.8 * parameters.street_width, -0.25 * centre[2])
    return Camera("billboard", tuple(map(float, eye)), tuple(map(float, centre)), _FOV)


def _before_nearest_pane(
    parameters: CityParameters, building: Building, wanted: FloatArray, distance: float
) -> tuple[FloatArray, FloatArray]:
    """An eye before the pane of the building that is nearest to ``wanted`` (lit ones first), and
    the direction along its facade to the right."""
    windows = building.windows
    candidates = np.flatnonzero(windows.light_on)
    if len(candidates) == 0:
        candidates = np.arange(len(windows))
    centres = building.origin + windows.centres[candidates]
    nearest = candidates[np.argmin(((centres - wanted) ** 2).sum(axis=1))]
    half_u, half_v = windows.half_u[nearest], windows.half_v[nearest]
    outward = np.cross(half_u, half_v)
    outward /= np.linalg.norm(outward)
    eye = building.origin + windows.centres[nearest]
    eye = eye + min(distance, 0.5 * parameters.street_width) * outward
    return eye, -half_u


def _inside(parameters: CityParameters, grid: StreetGrid, shapes: BuildingShapes) -> Camera:
    """In the middle of the central crossing, half as high as its haze, looking a little down
    along the street to the east."""
    columns, rows = parameters.grid
    i, j = _central_street(columns), _central_street(rows)
    y = 0.5 * float(grid.y[j] + grid.y[j + 1])
    height = 0.5 * float(box_tops(shapes.heights)[j, i])
    eye = (_street_centre(parameters, grid), y, height)
    return look_along("inside", eye, (1.0, 0.35, -0.15), _FOV)
