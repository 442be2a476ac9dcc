# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A real town from a CityJSON file: meshes, windows, haze, light lists and cameras."""

from __future__ import annotations

import dataclasses
import re
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from nightcity.city.cityjson import CityJson, read_cityjson
from nightcity.city.cityjson_buildings import SourceBuilding, source_buildings
from nightcity.city.cityjson_geometry import Surface
from nightcity.city.free_space import FreeSpace
from nightcity.city.model import (
    Building,
    City,
    FloatArray,
    IntArray,
    LightLists,
    Material,
    MediaBox,
    Mesh,
    Windows,
)
from nightcity.city.moving_cameras import moving_cameras
from nightcity.city.night import night_of, with_night
from nightcity.city.seeds import Purpose, generator
from nightcity.city.street_media import street_media
from nightcity.city.town_cameras import town_cameras
from nightcity.city.town_meshes import TownMesh, building_mesh
from nightcity.city.town_options import TownOptions
from nightcity.city.wall_windows import LaidWindows, lay_windows, with_free_space
from nightcity.city.window_colours import draw_colours
from nightcity.errors import SceneError
from nightcity.light_lists import light_lists, window_bounds
from nightcity.progress import Progress

_WALLS = (
    Material("wall_brick", (0.32, 0.17, 0.12)),
    Material("wall_sandstone", (0.45, 0.38, 0.28)),
    Material("wall_render", (0.55, 0.52, 0.48)),
    Material("wall_dark_brick", (0.2, 0.15, 0.13)),
)
_ROOFS = (Material("roof_tile", (0.3, 0.14, 0.1)), Material("roof_slate", (0.15, 0.15, 0.17)))
_GROUND = Material("ground", (0.08, 0.08, 0.08))  # worn asphalt
_MATERIALS = (*_WALLS, *_ROOFS, _GROUND)
_LARGEST_BUILDING = 10_000.0  # m in any direction
_LARGEST_TOWN = 200_000.0  # m in any direction


def import_town(path: Path, options: TownOptions | None = None) -> City:
    """The town in a CityJSON file, as a city about an origin in its middle, on the plane z = 0.

    ``notes`` says what was left out or mended. SceneError names what is wrong with the file.
    """
    options = options or TownOptions()
    notes: Counter[str] = Counter()
    file = read_cityjson(path)
    sources = source_buildings(file, options.lod, notes)
    meshes, origin, grounds = _meshes(file, sources, notes)
    corners = np.concatenate([mesh.corners() for mesh in meshes])
    space = FreeSpace(corners)
    laid = lay_windows(meshes, options)
    laid = laid.take(with_free_space(laid, space, options.window_clearance))
    windows = _windows(laid, options)
    media = street_media(corners, options)
    cameras = town_cameras(meshes, laid, windows.light_on, media, space, notes)
    night = night_of(options.time, options.frames, options.office_share, options.seed)
    return City(
        name=_identifier(path),
        buildings=tuple(with_night(_buildings(meshes, laid, windows, options), night)),
        media=media,
        light_lists=_light_lists(windows, media),
        cameras=(*cameras, *moving_cameras(cameras, options.frames)),
        materials=_MATERIALS,
        ground_material=_MATERIALS.index(_GROUND),
        origin_offset=origin,
        crs=file.crs,
        parameters={
            "source": path.name,
            "cityjson": file.version,
            "ground": {"lowest": min(grounds), "highest": max(grounds)},
            "options": dataclasses.asdict(options),
        },
        resolution=options.resolution,
        frames=options.frames,
        notes=_sentences(notes),
    )


def _meshes(
    file: CityJson, sources: Sequence[SourceBuilding], notes: Counter[str]
) -> tuple[list[TownMesh], tuple[float, float, float], list[float]]:
    """The meshes about the town's origin, that origin in the file's coordinates, and the height
    of each building's ground there, m. The origin's height is the median of the grounds."""
    middle = _middle(file, sources)
    points = file.vertices - middle
    found = []
    with Progress("reading buildings", len(sources)) as progress:
        for source in sources:
            found.append(building_mesh(source, points, notes))
            progress.advance()
    kept = [item for item in found if item is not None]
    if not kept:
        raise SceneError(f"{file.path}: no building has a shape; {'; '.join(_sentences(notes))}")
    grounds = [round(float(ground + middle[2]), 3) for _, ground in kept]
    for mesh, _ in kept:
        if np.ptp(mesh.positions, axis=0).max() > _LARGEST_BUILDING:
            raise SceneError(
                f"{file.path}: CityObjects[{mesh.name!r}]: larger than {_LARGEST_BUILDING:g} m; "
                "mend its vertices or the transform"
            )
    return (
        [mesh for mesh, _ in kept],
        (float(middle[0]), float(middle[1]), float(np.median(grounds))),
        grounds,
    )


def _middle(file: CityJson, sources: Sequence[SourceBuilding]) -> FloatArray:
    """The middle of the bounding box of all buildings, in whole metres."""
    used = np.zeros(len(file.vertices), dtype=bool)
    for source in sources:
        bodies = source.parts if source.own is None else (source.own, *source.parts)
        for found in (polygons for body in bodies for polygons in body.polygons):
            used[[index for rings in found.rings for ring in rings for index in ring]] = True
    points = file.vertices[used]
    lo, hi = points.min(axis=0), points.max(axis=0)
    if (hi - lo).max() > _LARGEST_TOWN:
        raise SceneError(
            f"{file.path}: vertices: the buildings span {(hi - lo).max():.4g} m, more than "
            f"{_LARGEST_TOWN:g} m; look for a stray vertex or a wrong transform"
        )
    return np.round(0.5 * (lo + hi))


def _windows(laid: LaidWindows, options: TownOptions) -> Windows:
    """All windows of the town, about its origin; ids count up in the order of buildings."""
    count = len(laid)
    lit = generator(options.seed, Purpose.LIT).random(count) < options.lit
    colours = generator(options.seed, Purpose.COLOURS)
    return Windows(
        centres=laid.centres,
        half_u=laid.half_u,
        half_v=laid.half_v,
        power=np.full(count, options.window_power),
        colours=draw_colours(options.window_colours, count, colours),
        light_on=lit,
        ids=np.arange(count),
    )


def _buildings(
    meshes: Sequence[TownMesh], laid: LaidWindows, windows: Windows, options: TownOptions
) -> tuple[Building, ...]:
    rng = generator(options.seed, Purpose.TEXTURES)
    walls = rng.integers(len(_WALLS), size=len(meshes))
    roofs = len(_WALLS) + rng.integers(len(_ROOFS), size=len(meshes))
    ends = np.searchsorted(laid.building, np.arange(len(meshes) + 1))
    buildings = []
    for number, mesh in enumerate(meshes):
        lo, hi = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
        # Whole metres, so that the stage's float32 positions add up to the town's exactly.
        origin = np.round(0.5 * (lo + hi)) * (1.0, 1.0, 0.0)
        materials = np.where(mesh.surfaces == Surface.ROOF, roofs[number], walls[number])
        own = slice(ends[number], ends[number + 1])
        buildings.append(
            Building(
                building_id=number,
                origin=origin,
                mesh=Mesh(
                    positions=mesh.positions - origin,
                    counts=np.full(len(mesh.triangles), 3),
                    indices=mesh.triangles.ravel(),
                    materials=materials,
                ),
                windows=Windows(
                    centres=windows.centres[own] - origin,
                    **{
                        field.name: getattr(windows, field.name)[own]
                        for field in dataclasses.fields(Windows)
                        if field.name != "centres"
                    },
                ),
                name=mesh.name,
            )
        )
    return tuple(buildings)


def _light_lists(windows: Windows, media: Sequence[MediaBox]) -> LightLists:
    offsets, indices = light_lists(
        *window_bounds(windows.centres, windows.half_u, windows.half_v),
        np.array([box.lo for box in media]),
        np.array([box.hi for box in media]),
        np.array([box.reach_scale for box in media]),
    )
    ids: IntArray = windows.ids[indices]
    return LightLists(offsets, ids)


def _identifier(path: Path) -> str:
    """The file's name without endings, as the name of a prim."""
    name = re.sub(r"[^A-Za-z0-9_]", "_", path.name.split(".")[0])
    return name if name and not name[0].isdigit() else f"town_{name}"


def _sentences(notes: Counter[str]) -> tuple[str, ...]:
    return tuple(f"{text}: {count}" for text, count in notes.items())
