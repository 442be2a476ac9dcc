# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters -> city: buildings on a street grid, haze between them, after the paper."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np

from nightcity.city.box_buildings import box_mesh, city_materials
from nightcity.city.facades import city_windows
from nightcity.city.grid_cameras import grid_cameras
from nightcity.city.heights import BuildingShapes, building_shapes
from nightcity.city.model import Building, City, FloatArray, LightLists, MediaBox, Mesh
from nightcity.city.moving_cameras import moving_cameras
from nightcity.city.night import night_of, with_night
from nightcity.city.parameters import CityParameters
from nightcity.city.seeds import Purpose, generator
from nightcity.city.street_grid import StreetGrid, media_boxes, street_grid
from nightcity.city.textures import FacadeTexture, facade_textures
from nightcity.light_lists import light_lists, window_bounds
from nightcity.progress import Progress


def generate(parameters: CityParameters) -> City:
    """The city of these parameters, the same to the bit for the same parameters.

    Buildings and their ids run row by row from the south-west, windows as facades.py says, media
    boxes as street_grid.py says. All arrays are read-only; buildings of one shape share some.
    UsageError where a texture cannot be read or the billboard has no room.
    """
    textures = facade_textures(parameters.facade_textures, parameters.facade_texture_size)
    grid, shapes = street_grid(parameters), building_shapes(parameters)
    buildings = _buildings(parameters, grid, shapes, textures)
    media = media_boxes(parameters, grid, shapes.heights)
    materials = city_materials(parameters, textures)
    cameras = grid_cameras(parameters, grid, shapes, buildings)
    night = night_of(parameters.time, parameters.frames, parameters.office_share, parameters.seed)
    return City(
        name=parameters.name,
        buildings=tuple(with_night(buildings, night)),
        media=media,
        light_lists=_light_lists(buildings, media),
        cameras=(*cameras, *moving_cameras(cameras, parameters.frames)),
        materials=materials,
        ground_material=len(materials) - 1,
        parameters=_described(parameters),
        resolution=parameters.resolution,
        frames=parameters.frames,
    )


def _buildings(
    parameters: CityParameters,
    grid: StreetGrid,
    shapes: BuildingShapes,
    textures: tuple[FacadeTexture, ...],
) -> list[Building]:
    base, roof = parameters.building_base, len(textures)
    heights = shapes.heights.ravel()
    origins = np.zeros((heights.size, 3))
    origins[:, :2] = grid.building_centres().reshape(-1, 2)
    origins.setflags(write=False)
    facades = generator(parameters.seed, Purpose.TEXTURES).integers(
        len(textures), size=len(origins)
    )
    meshes: dict[tuple[float, int], Mesh] = {}
    buildings = []
    with Progress("generating buildings", len(origins)) as progress:
        for index, windows in enumerate(city_windows(parameters, shapes)):
            look = float(heights[index]), int(facades[index])
            if look not in meshes:
                meshes[look] = box_mesh(base, *look, roof, textures[look[1]].size)
            buildings.append(Building(index, origins[index], meshes[look], windows))
            progress.advance()
    return buildings


def _light_lists(buildings: list[Building], media: tuple[MediaBox, ...]) -> LightLists:
    """Window ids are indices here: both run through the buildings in order."""
    bounds: dict[int, tuple[FloatArray, FloatArray]] = {}  # buildings of one shape share a layout
    lo, hi = [], []
    for building in buildings:
        windows = building.windows
        layout = id(windows.centres)
        if layout not in bounds:
            bounds[layout] = window_bounds(windows.centres, windows.half_u, windows.half_v)
        lo.append(bounds[layout][0] + building.origin)
        hi.append(bounds[layout][1] + building.origin)
    offsets, indices = light_lists(
        np.concatenate(lo),
        np.concatenate(hi),
        np.array([box.lo for box in media]),
        np.array([box.hi for box in media]),
        np.array([box.reach_scale for box in media]),
    )
    offsets.setflags(write=False)
    indices.setflags(write=False)
    return LightLists(offsets, indices)


def _described(parameters: CityParameters) -> dict[str, object]:
    """The parameters as metadata; of texture files only the name, so that no path gets out."""
    values = dataclasses.asdict(parameters)
    values["facade_textures"] = [Path(name).name for name in parameters.facade_textures]
    return {name: _plain(value) for name, value in values.items()}


def _plain(value: object) -> object:
    return [_plain(part) for part in value] if isinstance(value, tuple | list) else value
