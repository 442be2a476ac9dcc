# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Small cities, made by hand, for the tests of the stage."""

from __future__ import annotations

import numpy as np

from nightcity.city.model import (
    Building,
    Camera,
    City,
    LightLists,
    Material,
    MediaBox,
    Mesh,
    Windows,
)
from nightcity.light_lists import light_lists, window_bounds

BRICKS = np.array([[[200, 90, 70], [180, 80, 60]], [[90, 40, 30], [70, 30, 20]]], np.uint8)


def box_mesh(width: float, depth: float, height: float) -> Mesh:
    """Walls of material 0 and a roof of material 1, with texture coordinates in metres."""
    corners = [(0, 0), (width, 0), (width, depth), (0, depth)]
    positions = np.array([(x, y, z) for z in (0, height) for x, y in corners], float)
    walls = [[i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4] for i in range(4)]
    faces = [*walls, [4, 5, 6, 7], [3, 2, 1, 0]]
    texcoords = np.tile([[0, 0], [width, 0], [width, height], [0, height]], (6, 1))
    return Mesh(
        positions=positions,
        counts=np.full(6, 4),
        indices=np.array(faces).ravel(),
        materials=np.array([0, 0, 0, 0, 1, 1]),
        texcoords=texcoords.astype(float),
    )


def wall_windows(width: float, depth: float, first_id: int) -> Windows:
    """One window a wall, 1.2 x 1.5 m, 0.01 m outside, 5 m up; the second is off."""
    normal = np.array([(0, -1, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0)], float)
    along = np.array([(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)], float)
    middle = np.array([(width / 2, 0), (width, depth / 2), (width / 2, depth), (0, depth / 2)])
    return Windows(
        centres=np.column_stack([middle, np.full(4, 5.0)]) + 0.01 * normal,
        half_u=0.6 * along,
        half_v=np.tile([0, 0, 0.75], (4, 1)),
        power=np.full(4, 50.0),
        colours=np.array([(1, 0.8, 0.5), (1, 0.8, 0.5), (0.7, 0.8, 1), (1, 1, 1)]),
        light_on=np.array([True, False, True, True]),
        ids=first_id + np.arange(4),
    )


def media_row(edges: list[float], height: float) -> tuple[MediaBox, ...]:
    """Boxes beside one another along x, one shared face between neighbours, 10 m wide in y."""
    return tuple(
        MediaBox(
            media_id=index,
            lo=np.array([edges[index], -10.0, 0.0]),
            hi=np.array([edges[index + 1], 0.0, height]),
            extinction=0.01,
            albedo=0.9,
            reach_scale=1.2 if index else 1.5,
        )
        for index in range(len(edges) - 1)
    )


def lists_by_rule(buildings: tuple[Building, ...], media: tuple[MediaBox, ...]) -> LightLists:
    """The lists that the paper's rule gives; window i has the id i."""
    bounds = [
        window_bounds(each.windows.centres + each.origin, each.windows.half_u, each.windows.half_v)
        for each in buildings
    ]
    lo, hi = (np.concatenate(corners) for corners in zip(*bounds, strict=True))
    offsets, found = light_lists(
        lo,
        hi,
        [box.lo for box in media],
        [box.hi for box in media],
        [box.reach_scale for box in media],
    )
    return LightLists(offsets, found)


def small_city(buildings: int = 2) -> City:
    """A row of buildings along x, each 10 m wide, 10 m apart; boxes before them hold haze."""
    row = tuple(
        Building(
            building_id=index,
            origin=np.array([20.0 * index, 0.0, 0.0]),
            mesh=box_mesh(10, 10, 30),
            windows=wall_windows(10, 10, 4 * index),
            name=f"House {index}",
        )
        for index in range(buildings)
    )
    media = media_row([20.0 * index for index in range(buildings + 1)], 30.0)
    return City(
        name="Small",
        buildings=row,
        media=media,
        light_lists=lists_by_rule(row, media),
        cameras=(
            Camera("overview", (95.0, -125.0, 62.0), (0.0, 0.0, 6.0), 33.141),
            Camera("street", (1.5, -38.0, 2.0), (0.0, 10.0, 14.0), 60.0),
        ),
        materials=(
            Material("wall", (0.5, 0.4, 0.3), BRICKS),
            Material("roof", (0.2, 0.2, 0.2)),
            Material("ground", (0.1, 0.1, 0.1)),
        ),
        ground_material=2,
        origin_offset=(84000.0, 447000.0, 0.0),
        crs="EPSG:7415",
        parameters={"seed": 7, "grid": 2},
        notes=("3 bridges were skipped",),
    )
