# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Windows on the walls of real towns: where they go and where they must not."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from town_files import Ring, TownFile, box, house

from nightcity.city.import_town import import_town
from nightcity.city.model import City, FloatArray
from nightcity.city.town_options import TownOptions
from nightcity.errors import UsageError

OPTIONS = TownOptions(lit=1.0)


def town_of(folder: Path, *buildings: list[list[Ring]], options: TownOptions = OPTIONS) -> City:
    town = TownFile("1.0")
    for number, faces in enumerate(buildings):
        town.add(f"b{number}", faces, kind="MultiSurface")
    return import_town(town.write(folder), options)


def centres(city: City, building: int = 0) -> FloatArray:
    """Of one building's windows, in the file's x and y."""
    item = city.buildings[building]
    return item.windows.centres + item.origin + (*city.origin_offset[:2], 0.0)


def outward(city: City, building: int = 0) -> FloatArray:
    windows = city.buildings[building].windows
    normals = np.cross(windows.half_u, windows.half_v)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def rows(points: FloatArray) -> set[tuple[float, ...]]:
    return {tuple(map(float, p)) for p in np.round(points, 6) + 0.0}


def test_grid_on_a_plain_wall(tmp_path: Path) -> None:
    """10 x 8 x 7 m: two floors of 3 m; 4 windows at 2.4 m fit along 10 m, 3 along 8 m."""
    city = town_of(tmp_path, box((0, 0, 0), (10, 8, 7)))
    points = centres(city)
    x, y = (1.4, 3.8, 6.2, 8.6), (1.6, 4.0, 6.4)
    wanted = {(u, v, z) for z in (1.5, 4.5) for u in x for v in (-0.01, 8.01)}
    wanted |= {(u, v, z) for z in (1.5, 4.5) for u in (-0.01, 10.01) for v in y}
    assert rows(points) == rows(np.array(sorted(wanted)))
    windows = city.buildings[0].windows
    assert np.linalg.norm(windows.half_u, axis=1) == pytest.approx(0.6)
    assert np.linalg.norm(windows.half_v, axis=1) == pytest.approx(0.75)
    assert (windows.half_v[:, 2] > 0).all()
    away = points - (5, 4, 0)
    side = np.abs(away[:, :2] / (5.01, 4.01)) > 0.999
    assert outward(city)[:, :2] == pytest.approx(np.sign(away[:, :2]) * side, abs=1e-12)


@pytest.mark.parametrize("cuts", [2, 3, 7])
def test_a_wall_cut_into_faces_is_one_wall(tmp_path: Path, cuts: int) -> None:
    """The south wall as strips, with T-junctions at the top: as if it were one face."""
    whole = box((0, 0, 0), (10, 8, 7))
    x = np.round(np.linspace(0, 10, cuts + 1), 3)  # as files store them; outlines snap to this
    strips = [[[(a, 0, 0), (b, 0, 0), (b, 0, 7), (a, 0, 7)]] for a, b in pairwise(x)]
    across = [
        [[(0, 0, 0), (10, 0, 0), (10, 0, 2)]],
        [[(0, 0, 0), (10, 0, 2), (10, 0, 7), (0, 0, 7)]],
    ]
    expected = rows(centres(town_of(tmp_path, whole)))
    assert rows(centres(town_of(tmp_path, strips + whole[1:]))) == expected
    assert rows(centres(town_of(tmp_path, across + whole[1:]))) == expected


@pytest.mark.parametrize("split", [False, True])
def test_gables_carry_whole_windows_only(tmp_path: Path, split: bool) -> None:
    """Eaves at 5 m, ridge at 10 m over 8 m: on the gable (x = 10) the second row fits only where
    the roof line is above the window's upper corners with the margin."""
    city = town_of(tmp_path, house((0, 0, 0), (10, 8, 5), 10, split=split))
    points = centres(city)
    gable = points[np.isclose(points[:, 0], 10.01)]
    assert rows(gable[:, 1:]) == rows(
        np.array(
            [(y, 1.5) for y in (1.6, 4.0, 6.4)] + [(y, 4.5) for y in (1.6, 4.0, 6.4)] + [(4, 7.5)]
        )
    )
    eaves = points[np.isclose(points[:, 1], -0.01)]
    assert set(eaves[:, 2]) == {1.5}  # 4.5 + 0.75 + 0.15 m is above the eaves


def test_no_window_over_a_hole(tmp_path: Path) -> None:
    """A gateway through the south wall, as an inner ring: the two windows it cuts are missing."""
    faces = box((0, 0, 0), (10, 8, 7))
    faces[0].append([(3, 0, 0.5), (3, 0, 3), (7, 0, 3), (7, 0, 0.5)])
    points = centres(town_of(tmp_path, faces))
    south = points[np.isclose(points[:, 1], -0.01)]
    assert rows(south[:, [0, 2]]) == rows(
        np.array([(1.4, 1.5), (8.6, 1.5), (1.4, 4.5), (3.8, 4.5), (6.2, 4.5), (8.6, 4.5)])
    )


def test_none_on_party_walls_and_above_the_lower_neighbour_again(tmp_path: Path) -> None:
    """A terrace of a high and a low house: windows look over the low roof, none into it."""
    city = town_of(tmp_path, box((0, 0, 0), (10, 8, 10)), box((10, 0, 0), (20, 8, 4)))
    high, low = centres(city, 0), centres(city, 1)
    east = high[np.isclose(high[:, 0], 10.01)]
    assert set(east[:, 2]) == {7.5}  # 4.5 m has its lower edge 0.25 m below the roof
    assert not np.isclose(low[:, 0], 9.99).any()
    assert np.isclose(low[:, 0], 20.01).any()


@pytest.mark.parametrize("gap, free", [(0.0, False), (0.02, False), (0.9, False), (1.2, True)])
def test_free_space_in_front(tmp_path: Path, gap: float, free: bool) -> None:
    x = 10 + gap
    city = town_of(tmp_path, box((0, 0, 0), (10, 8, 7)), box((x, 0, 0), (x + 6, 8, 7)))
    assert np.isclose(centres(city, 0)[:, 0], 10.01).any() == free
    assert np.isclose(centres(city, 1)[:, 0], x - 0.01).any() == free


def test_none_inside_an_overlapping_neighbour(tmp_path: Path) -> None:
    """The second house starts 3 m inside the first, farther than the clearance sees."""
    city = town_of(tmp_path, box((0, 0, 0), (10, 8, 7)), box((7, -2, 0), (16, 10, 7)))
    first, second = centres(city, 0), centres(city, 1)
    assert (first[:, 0] < 7).all()
    inside = (second[:, 0] < 10) & (second[:, 1] > 0) & (second[:, 1] < 8)
    assert not inside.any()


def test_eaves_do_not_cost_windows(tmp_path: Path) -> None:
    slab = box((-2, -2, 7), (12, 10, 7.3))  # overhangs by 2 m, with an underside
    assert len(centres(town_of(tmp_path, box((0, 0, 0), (10, 8, 7)) + slab))) == 28


def test_sheds_slopes_and_roof_faces_carry_none(tmp_path: Path) -> None:
    shed = town_of(tmp_path, box((0, 0, 0), (3, 3, 3)))
    assert len(shed.buildings[0].windows) == 0
    leaning = [
        [[(x + (2 if z else 0), y, z) for x, y, z in ring] for ring in face]
        for face in box((0, 0, 0), (10, 8, 7))
    ]
    points = centres(town_of(tmp_path, leaning))
    assert not np.isclose(np.abs(outward(town_of(tmp_path, leaning))[:, 0]), 1, atol=0.1).any()
    assert len(points)


def test_wall_semantics_decide(tmp_path: Path) -> None:
    """The same box whose south and north walls are declared roof: only the others carry windows."""
    town = TownFile()
    geometry = town.add("house", box((0, 0, 0), (10, 8, 7)))
    kinds = ["RoofSurface", "WallSurface", "GroundSurface"]
    geometry["semantics"] = {
        "surfaces": [{"type": kind} for kind in kinds],
        "values": [[0, 1, 0, 1, 0, 2]],
    }
    city = import_town(town.write(tmp_path), OPTIONS)
    assert len(city.buildings[0].windows) == 12
    assert (np.abs(outward(city)[:, 0]) > 0.99).all()


def test_lit_share_colours_and_seed(tmp_path: Path) -> None:
    def windows_of(**options: object) -> tuple:
        city = town_of(tmp_path, box((0, 0, 0), (100, 80, 40)), options=TownOptions(**options))
        return city.buildings[0].windows

    windows = windows_of(lit=0.3, window_power=20, seed=7)
    assert len(windows) > 1500
    assert windows.light_on.mean() == pytest.approx(0.3, abs=0.04)  # 3 standard deviations
    assert set(windows.power) == {20.0}
    colours = {tuple(colour) for colour in windows.colours}
    assert colours == {tuple(row[:3]) for row in TownOptions().window_colours}
    again, other = windows_of(lit=0.3, seed=7), windows_of(lit=0.3, seed=8)
    assert (again.light_on == windows.light_on).all()
    assert (other.light_on != windows.light_on).any()
    assert windows_of(lit=0.0).light_on.sum() == 0
    assert windows_of(lit=1.0).light_on.all()


@pytest.mark.parametrize(
    "options, message",
    [
        ({"window_spacing": 1.0}, "window_spacing is below window_width"),
        ({"window_height": 3.5}, "floor_height is below window_height"),
        ({"floor_height": 0.0}, "^floor_height = 0.0 is out of range"),
        ({"lit": 1.5}, "^lit = 1.5 is out of range"),
        ({"cell_size": float("nan")}, "^cell_size = NaN must be a finite number"),
        ({"window_colours": []}, "^window_colours = "),
    ],
)
def test_options_are_checked(options: dict[str, object], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        TownOptions(**options)
