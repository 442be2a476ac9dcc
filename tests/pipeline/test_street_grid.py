# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Heights, haze boxes and cameras of generated cities that are not the paper's."""

from __future__ import annotations

import numpy as np
import pytest

from nightcity.city.cameras import frame_height_share
from nightcity.city.generate import generate
from nightcity.city.heights import building_shapes, noise_rank
from nightcity.city.parameters import CityParameters, load_parameters, preset_names
from nightcity.city.street_grid import box_tops, media_boxes, street_grid

FLOORS = {"heights": "floors", "min_height": 10.0, "max_height": 80.0}
CITIES = [
    CityParameters(grid=(5, 3), **FLOORS, seed=4),
    CityParameters(grid=(3, 4), **FLOORS, haze_layer_thickness=12.5, street_width=7.3),
    CityParameters(grid=(2, 5), big_share=0.4, haze_layer_thickness=0.01, building_base=13.7),
    CityParameters(grid=(1, 1), haze_layer_thickness=40.0, street_width=4.0),
    CityParameters(grid=(7, 2), **FLOORS, floor_height=3.3, lit=0.0),
    CityParameters(grid=(1, 3), billboard_power=900.0, lit=0.1),
]


def solids_and_haze(parameters):
    city = generate(parameters)
    buildings = np.array(
        [np.percentile(b.origin + b.mesh.positions, (0, 100), axis=0) for b in city.buildings]
    )
    return city, buildings, np.array([(box.lo, box.hi) for box in city.media])


@pytest.mark.parametrize("parameters", CITIES, ids=range(len(CITIES)))
def test_buildings_and_haze_tile_the_city(parameters):
    """Nothing overlaps, and volumes add up: so no gap either, up to the top of each column."""
    _, buildings, haze = solids_and_haze(parameters)
    boxes = np.concatenate([buildings, haze])
    lo, hi = boxes[:, 0], boxes[:, 1]
    assert (hi > lo).all()
    apart = ((lo[:, None] >= hi) | (hi[:, None] <= lo)).any(axis=2)
    assert (apart | np.eye(len(boxes), dtype=bool)).all()
    if parameters.haze_layer_thickness > 0:
        extent = np.ptp(boxes, axis=(0, 1))
        assert extent[2] == buildings[:, 1, 2].max() + parameters.haze_layer_thickness
        np.testing.assert_allclose((hi - lo).prod(axis=1).sum(), extent.prod(), rtol=1e-12)


@pytest.mark.parametrize("parameters", CITIES, ids=range(len(CITIES)))
def test_shared_faces_are_equal_to_the_bit_also_in_float32(parameters):
    """Every plane of the grid has one coordinate, and float32 holds it."""
    _, buildings, haze = solids_and_haze(parameters)
    columns, rows = parameters.grid
    boxes = np.concatenate([buildings, haze])
    assert len(np.unique(boxes[..., 0])) == 2 * columns + 2
    assert len(np.unique(boxes[..., 1])) == 2 * rows + 2
    assert (boxes.astype(np.float32) == boxes).all()


@pytest.mark.parametrize("parameters", CITIES, ids=range(len(CITIES)))
def test_street_boxes_are_as_high_as_the_tallest_building_around(parameters):
    _, buildings, haze = solids_and_haze(parameters)
    streets = haze[haze[:, 0, 2] == 0]
    columns, rows = parameters.grid
    assert len(streets) == (2 * columns + 1) * (2 * rows + 1) - columns * rows
    for lo, hi in streets:
        meets = (buildings[:, 0, :2] <= hi[:2]) & (buildings[:, 1, :2] >= lo[:2])
        assert hi[2] == buildings[meets.all(axis=1), 1, 2].max()


def test_haze_layer_is_numbered_last_and_has_its_own_haze():
    city, _, haze = solids_and_haze(load_parameters("mixed-6x6"))
    layer = np.array([box.extinction == 0.004 for box in city.media])
    assert 0 < layer.sum() == 13 * 13
    assert (np.flatnonzero(layer) == np.arange(len(layer))[-169:]).all()
    assert {box.albedo for box in np.array(city.media)[layer]} == {0.95}
    assert (haze[layer, 1, 2] == haze[layer, 1, 2].max()).all() and (haze[layer, 0, 2] > 0).all()


def test_box_tops_by_hand():
    tops = box_tops(np.array([[10.0, 30.0]]))
    assert tops.tolist() == [[10, 10, 30, 30, 30], [10, 10, 30, 30, 30], [10, 10, 30, 30, 30]]


def test_edges_are_centred():
    grid = street_grid(CityParameters(grid=(2, 1), street_width=4.5, building_base=8))
    assert grid.x.tolist() == [-14.75, -10.25, -2.25, 2.25, 10.25, 14.75]
    assert grid.y.tolist() == [-8.5, -4, 4, 8.5]
    assert grid.building_centres().tolist() == [[[-6.25, 0], [6.25, 0]]]


def test_neighbours_are_alike_in_height():
    heights = building_shapes(CityParameters(grid=(80, 80), **FLOORS)).heights
    shuffled = np.random.default_rng(0).permutation(heights.ravel()).reshape(heights.shape)

    def roughness(h):
        return abs(np.diff(h, axis=0)).mean() + abs(np.diff(h, axis=1)).mean()

    assert roughness(heights) < 0.5 * roughness(shuffled)


def test_ranks_hold_every_place_once():
    rank = noise_rank(CityParameters(grid=(9, 7)))
    np.testing.assert_allclose(np.sort(rank.ravel()), (np.arange(63) + 0.5) / 63)


@pytest.mark.parametrize("share, big", [(0, 0), (0.25, 25), (0.5, 50), (1, 100)])
def test_share_of_big_buildings(share, big):
    shapes = building_shapes(CityParameters(grid=(10, 10), big_share=share))
    assert (shapes.heights == 60).sum() == big
    assert (shapes.window_rows == np.where(shapes.heights == 60, 10, 5)).all()


def test_floors_fill_the_range_and_have_a_row_of_windows_above_the_first():
    p = CityParameters(grid=(30, 30), heights="floors", min_height=12, max_height=60)
    shapes = building_shapes(p)
    assert shapes.heights.min() == 15 and shapes.heights.max() == 55
    assert (shapes.heights == 5 * (shapes.window_rows + 1)).all()
    low = building_shapes(CityParameters(grid=(30, 30), heights="floors", height_exponent=3))
    assert low.heights.mean() < shapes.heights.mean() - 5


def inside(boxes, point):
    return ((boxes[:, 0] < point) & (point < boxes[:, 1])).all(axis=1)


@pytest.mark.parametrize(
    "parameters",
    [*CITIES, *(load_parameters(n) for n in preset_names() if n != "city-100x100")],
)
def test_cameras_in_streets_stand_in_the_haze(parameters):
    city, buildings, haze = solids_and_haze(parameters)
    cameras = {camera.name: camera for camera in city.cameras}
    assert len(cameras) == len(city.cameras) and city.cameras[0].name == "overview75"
    for name, camera in cameras.items():
        eye = np.array(camera.position)
        assert not inside(buildings, eye).any(), name
        assert np.isfinite([camera.position, camera.target]).all()
        if name in ("street", "close", "inside", "billboard"):
            assert inside(haze, eye).sum() == 1, name
    top = (buildings[:, 1, 2].max(),)
    lo, hi = (*haze[:, 0].min(axis=0)[:2], 0.0), (*haze[:, 1].max(axis=0)[:2], *top)
    for name, share in {"overview25": 0.25, "overview50": 0.5, "overview75": 0.75,
                        "overview100": 1.0, "far25": 0.25}.items():  # fmt: skip
        assert frame_height_share(cameras[name], lo, hi) == pytest.approx(share, abs=5e-4)


@pytest.mark.parametrize("name", ["paper-1x1", "paper-4x4", "default", "mixed-6x6"])
def test_close_stands_two_metres_before_a_lit_window_and_looks_along_its_wall(name):
    city = generate(load_parameters(name))
    camera = next(camera for camera in city.cameras if camera.name == "close")
    found = 0
    for building in city.buildings:
        w = building.windows
        normal = np.cross(w.half_u, w.half_v)
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        eye = building.origin + w.centres + 2 * normal
        at = np.linalg.norm(eye - camera.position, axis=1) < 1e-9
        sight = np.subtract(camera.target, camera.position)
        found += (at & w.light_on & (abs(normal @ sight) < 1e-9)).sum()
    assert found == 1


def test_media_boxes_without_a_layer_hold_the_streets_only():
    p = CityParameters(grid=(3, 3), extinction=0.25, albedo=0.5)
    boxes = media_boxes(p, street_grid(p), building_shapes(p).heights)
    assert {(box.extinction, box.albedo, float(box.lo[2])) for box in boxes} == {(0.25, 0.5, 0.0)}
