# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Whole towns: the excerpts, their haze, light lists and cameras, checked by other means."""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path

import numpy as np
import pytest
from town_files import DELFT, DENHAAG, TownFile, box

from nightcity.city.cameras import frame_height_share
from nightcity.city.free_space import FreeSpace
from nightcity.city.import_town import import_town
from nightcity.city.model import City, FloatArray
from nightcity.city.town_options import TownOptions, add_arguments, options_from_arguments
from nightcity.errors import UsageError
from nightcity.stage.check_city import check_city

EXCERPTS = [DELFT, DENHAAG]


@pytest.fixture(scope="module", params=EXCERPTS, ids=["delft", "denhaag"])
def city(request: pytest.FixtureRequest) -> City:
    return import_town(request.param)


def all_corners(city: City) -> FloatArray:
    return np.concatenate(
        [(b.mesh.positions + b.origin)[b.mesh.indices.reshape(-1, 3)] for b in city.buildings]
    )


def hits(origin: FloatArray, direction: FloatArray, corners: FloatArray) -> FloatArray:
    """Distances to all triangles that one ray hits, by solving for barycentric coordinates."""
    found = []
    for a, b, c in corners:
        matrix = np.column_stack((a - b, a - c, direction))
        if abs(np.linalg.det(matrix)) < 1e-12:
            continue
        beta, gamma, distance = np.linalg.solve(matrix, a - origin)
        if beta >= -1e-9 and gamma >= -1e-9 and beta + gamma <= 1 + 1e-9 and distance > 0:
            found.append(distance)
    return np.sort(found)


def test_excerpts_make_a_sound_city(city: City) -> None:
    check_city(city)
    assert len(city.buildings) == {"delft_excerpt": 41, "denhaag_excerpt": 9}[city.name]
    assert all(len(building.mesh.counts) for building in city.buildings)
    assert np.abs([b.origin for b in city.buildings]).max() < 200
    ids = np.concatenate([b.windows.ids for b in city.buildings])
    assert (ids == np.arange(len(ids))).all() and len(ids) > 200
    assert "7415" in city.crs


def test_offset_leads_back_to_the_file(city: City) -> None:
    lowest = np.min([(b.mesh.positions + b.origin).min(axis=0) for b in city.buildings], axis=0)
    extent = {"delft_excerpt": (84900, 447505), "denhaag_excerpt": (78249, 457605)}[city.name]
    there = lowest[:2] + city.origin_offset[:2]
    assert np.abs(there - extent).max() < 700
    assert lowest[2] == 0


def test_every_window_lies_on_its_own_wall_and_looks_into_the_open(city: City) -> None:
    """Rays back into the wall: it is there, 10 to 15 mm behind the pane's corners. Rays ahead: no
    wall within a metre. Rays to the side and up from there: not inside a building."""
    everything = all_corners(city)
    for building in city.buildings[::3]:
        windows = building.windows
        own = (building.mesh.positions + building.origin)[building.mesh.indices.reshape(-1, 3)]
        for number in range(0, len(windows), 9):
            centre = windows.centres[number] + building.origin
            u, v = windows.half_u[number], windows.half_v[number]
            outward = np.cross(u, v) / np.linalg.norm(np.cross(u, v))
            for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                corner = centre + s * u + t * v
                behind = hits(corner, -outward, own)
                assert len(behind) and 0.0099 <= behind[0] <= 0.0151
            ahead = hits(centre, outward, everything)
            assert not len(ahead) or ahead[0] > 1.0
            assert (centre - v)[2] > 0.5


def test_inside_is_told_alike_by_parity(city: City) -> None:
    """FreeSpace.covered against counting crossings of an upward ray, at places inside and
    outside. Delft's solids have no floor and share no walls, so parity upwards holds there too."""
    corners = all_corners(city)
    lo, hi = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    rng = np.random.default_rng(3)
    points = rng.uniform(lo, (*hi[:2], 5.0), (150, 3))
    parity = [len(hits(point, np.array((0.0, 0, 1)), corners)) % 2 == 1 for point in points]
    assert FreeSpace(corners).covered(points).tolist() == parity
    assert 20 < sum(parity) < 130


def test_haze_fills_the_streets_without_overlap(city: City) -> None:
    lo = np.array([box.lo for box in city.media])
    hi = np.array([box.hi for box in city.media])
    assert ((hi - lo)[:, :2] == 20).all() and (lo[:, 2] == 0).all()
    cells = {tuple(cell) for cell in lo[:, :2] / 20}
    assert len(cells) == len(lo)  # whole multiples of the cell, each once: no overlap
    assert (lo[:, :2] / 20 == np.floor(lo[:, :2] / 20)).all()
    corners = all_corners(city)
    for centre, top in zip(0.5 * (lo + hi)[:, :2], hi[:, 2], strict=True):
        # As high as the tallest building in reach: its cell and the eight around.
        gap = np.maximum(
            corners[..., :2].min(axis=1) - (centre + 30),
            (centre - 30) - corners[..., :2].max(axis=1),
        ).max(axis=1)
        near = corners[gap <= 0, :, 2]
        assert 0 < top <= near.max()
        inside = (np.abs(corners[..., :2] - centre) <= 30).all(axis=2)
        assert top >= corners[inside, 2].max(initial=0)


def test_single_house_stands_in_nine_boxes_or_more(tmp_path: Path) -> None:
    town = TownFile()
    town.add("house", box((1, 1, 0), (11, 9, 6)))
    town.add("tower", box((201, 1, 0), (211, 9, 60)))
    city = import_town(town.write(tmp_path), TownOptions(cell_size=50))
    assert sorted({float(box.hi[2]) for box in city.media}) == [6, 60]
    assert all(box.extinction == 0.01 and box.albedo == 0.9 for box in city.media)
    assert all(box.reach_scale == 1.2 for box in city.media)
    assert [box.media_id for box in city.media] == list(range(len(city.media)))


def test_light_lists_hold_the_windows_near_each_box(city: City) -> None:
    """The rule written out box by box: a window's bounds scaled by 1.3 touch the box scaled by
    1.2."""
    windows = [b.windows for b in city.buildings]
    centres = np.concatenate([b.windows.centres + b.origin for b in city.buildings])
    half = 1.3 * np.concatenate([np.abs(w.half_u) + np.abs(w.half_v) for w in windows])
    lists = city.light_lists
    for number, media in enumerate(city.media):
        middle, reach = 0.5 * (media.lo + media.hi), 0.5 * (media.hi - media.lo) * 1.2
        touching = (np.abs(centres - middle) <= half + reach + 1e-3).all(axis=1)
        listed = lists.window_ids[lists.offsets[number] : lists.offsets[number + 1]]
        assert listed.tolist() == np.flatnonzero(touching).tolist()


def test_cameras_stand_in_the_open_and_see_lit_windows(city: City) -> None:
    cameras = {camera.name: camera for camera in city.cameras}
    overviews = ["overview75", "overview25", "overview50", "overview100", "far25"]
    assert list(cameras) == [*overviews, "street", "close"]
    corners = all_corners(city)
    lo, hi = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    assert frame_height_share(cameras["overview75"], lo, hi) == pytest.approx(0.75, abs=0.01)
    for name in ("street", "close"):
        camera = cameras[name]
        eye, target = np.array(camera.position), np.array(camera.target)
        assert len(hits(eye, np.array((0.0, 0, 1)), corners)) % 2 == 0
        view = (target - eye) / np.linalg.norm(target - eye)
        distance = hits(eye, view, corners)
        assert not len(distance) or distance[0] > 4
        assert seen_windows(city, eye, view, corners) >= 4
    eye = np.array(cameras["street"].position)
    assert any(((eye >= box.lo) & (eye < box.hi)).all() for box in city.media)
    assert nearest_pane(city, np.array(cameras["close"].position)) == pytest.approx(2.0, abs=1e-6)


def seen_windows(city: City, eye: FloatArray, view: FloatArray, corners: FloatArray) -> int:
    """Lit windows within 35 degrees of the view that face the eye with nothing between."""
    count = 0
    for building in city.buildings:
        lit = np.flatnonzero(building.windows.light_on)
        for centre, u, v in zip(
            building.windows.centres[lit] + building.origin,
            building.windows.half_u[lit],
            building.windows.half_v[lit],
            strict=True,
        ):
            to_window = centre - eye
            distance = np.linalg.norm(to_window)
            if to_window @ view < distance * np.cos(np.radians(35)):
                continue
            if to_window @ np.cross(u, v) >= 0:
                continue
            first = hits(eye, to_window / distance, corners)
            count += not len(first) or first[0] > distance
            if count >= 4:
                return count
    return count


def nearest_pane(city: City, eye: FloatArray) -> float:
    """Distance to the nearest lit window's centre."""
    return min(
        float(np.linalg.norm(b.windows.centres[b.windows.light_on] + b.origin - eye, axis=1).min())
        for b in city.buildings
        if b.windows.light_on.any()
    )


def test_town_without_lit_windows_keeps_its_overviews() -> None:
    city = import_town(DELFT, TownOptions(lit=0))
    assert [camera.name for camera in city.cameras][-1] == "far25"
    assert sum("cameras without a free place" in note for note in city.notes) == 2


def test_same_file_and_seed_give_the_same_city() -> None:
    first, second = import_town(DELFT), import_town(DELFT)
    assert first.cameras == second.cameras and first.parameters == second.parameters
    for a, b in zip(first.buildings, second.buildings, strict=True):
        assert (a.mesh.positions == b.mesh.positions).all()
        assert (a.windows.centres == b.windows.centres).all()
        assert (a.windows.light_on == b.windows.light_on).all()


def test_options_from_the_command_line() -> None:
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    given = parser.parse_args(["--lod", "2.2", "--floor-height", "3.5", "--lit", "0.8"])
    assert options_from_arguments(given) == TownOptions(lod="2.2", floor_height=3.5, lit=0.8)
    assert options_from_arguments(parser.parse_args([])) == TownOptions()
    for field in dataclasses.fields(TownOptions):
        assert "--" + field.name.replace("_", "-") in parser.format_help()
    with pytest.raises(UsageError, match=r"^--lod: lod = "):
        options_from_arguments(parser.parse_args(["--lod", "best"]))
