# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The generated city: the paper's scenes exactly, and rules that hold in every other."""

from __future__ import annotations

import dataclasses
import json
import pickle
from collections import Counter
from functools import cache
from itertools import product

import numpy as np
import pytest

from nightcity.city.generate import generate
from nightcity.city.model import City
from nightcity.city.parameters import CityParameters, load_parameters, preset_names

SMALL_PRESETS = [name for name in preset_names() if name != "city-100x100"]


@cache
def preset(name: str) -> City:
    return generate(load_parameters(name))


def window_centres(city: City) -> np.ndarray:
    return np.concatenate([b.origin + b.windows.centres for b in city.buildings])


def triangles(city: City) -> int:
    """As design section 3 counts them: 12 a box, buildings and haze, 2 a window, no ground."""
    faces = sum(int((b.mesh.counts - 2).sum()) for b in city.buildings)
    return faces + 12 * len(city.media) + 2 * sum(len(b.windows) for b in city.buildings)


@pytest.mark.parametrize(
    "n, buildings, windows, boxes, triangle_count",
    [(1, 1, 80, 8, 268), (2, 4, 320, 21, 940), (3, 9, 720, 40, 2028), (4, 16, 1280, 65, 3532)],
)
def test_counts_of_the_paper(n, buildings, windows, boxes, triangle_count):
    city = preset(f"paper-{n}x{n}")
    assert len(city.buildings) == buildings
    assert sum(len(b.windows) for b in city.buildings) == windows
    assert len(city.media) == boxes
    assert triangles(city) == triangle_count


def test_list_lengths_of_the_paper():
    lengths = np.diff(preset("paper-4x4").light_lists.offsets)
    assert Counter(lengths.tolist()) == {10: 4, 20: 28, 40: 33}


def test_light_lists_follow_the_rule():
    """Every window against every box, written out again from design section 3."""
    for name in ("paper-2x2", "mixed-6x6", "billboard"):
        city = preset(name)
        half = np.concatenate([abs(b.windows.half_u) + abs(b.windows.half_v)
                               for b in city.buildings])  # fmt: skip
        centres = window_centres(city)
        for i, box in enumerate(city.media):
            reach = (box.hi - box.lo) / 2 * box.reach_scale
            gap = abs(centres - (box.lo + box.hi) / 2) - 1.3 * half - reach
            expected = np.flatnonzero((gap <= 1e-6).all(axis=1))
            a, b = city.light_lists.offsets[i : i + 2]
            assert city.light_lists.window_ids[a:b].tolist() == expected.tolist()


def test_windows_of_the_paper_stand_where_it_says():
    """2, 4, 6, 8 m along and 5 ... 25 m up each face, 0.01 m off it, 1.2 x 1.5 m, 50 W, white."""
    building = preset("paper-4x4").buildings[6]  # row 1, column 2
    assert building.origin.tolist() == [10, -10, 0]
    expected = []
    for face in ("south", "east", "north", "west"):
        for z, along in product((5, 10, 15, 20, 25), (2, 4, 6, 8)):
            expected.append(
                {
                    "south": (along - 5, -5.01, z),
                    "east": (5.01, along - 5, z),
                    "north": (5 - along, 5.01, z),
                    "west": (-5.01, 5 - along, z),
                }[face]
            )
    windows = building.windows
    np.testing.assert_allclose(windows.centres, expected, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(windows.half_u, axis=1), 0.6)
    np.testing.assert_array_equal(windows.half_v, np.tile((0, 0, 0.75), (80, 1)))
    assert windows.light_on.all() and (windows.power == 50).all() and (windows.colours == 1).all()
    assert windows.ids.tolist() == list(range(480, 560))


def test_media_of_the_paper():
    media = preset("paper-4x4").media
    assert {(box.extinction, box.albedo) for box in media} == {(0.01, 0.9)}
    assert {float(box.hi[2]) for box in media} == {30.0} and {box.lo[2] for box in media} == {0}
    corners = [box for box in media if box.reach_scale == 1.5]
    assert len(corners) == 25 and {box.reach_scale for box in media} == {1.2, 1.5}
    for box in corners:
        assert ((box.lo[:2] + 45) % 20 == 0).all() and (box.hi[:2] - box.lo[:2] == 10).all()


def test_paper_cameras():
    cameras = {c.name: c for c in preset("paper-4x4").cameras}
    assert list(cameras) == ["overview75", "overview25", "overview50", "overview100", "far25",
                             "street", "close", "inside"]  # fmt: skip
    assert cameras["overview75"].position == (95, -125, 62)
    assert cameras["overview75"].target == (0, 0, 6)
    street = cameras["street"]
    assert (street.position, street.target) == ((1.5, -38, 2), (0, 10, 14))
    assert street.vertical_fov_degrees == 60
    assert cameras["far25"].position == (300, -390, 150)


@pytest.mark.parametrize("name", SMALL_PRESETS)
def test_windows_point_outward_before_their_walls(name):
    for building in preset(name).buildings:
        w, lo, hi = building.windows, *np.percentile(building.mesh.positions, (0, 100), axis=0)
        normal = np.cross(w.half_u, w.half_v)
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        np.testing.assert_allclose(abs(normal).max(axis=1), 1)
        distance = (w.centres * normal).sum(axis=1) - hi[0]
        np.testing.assert_allclose(distance, 0.01, atol=1e-12)
        reach = abs(w.half_u) + abs(w.half_v)
        inside = (w.centres - reach >= lo - 0.0101) & (w.centres + reach <= hi + 0.0101)
        assert inside.all()


@pytest.mark.parametrize("name", SMALL_PRESETS)
def test_windows_do_not_overlap(name):
    for building in preset(name).buildings:
        w = building.windows
        width, height = np.linalg.norm(w.half_u, axis=1), w.half_v[:, 2]
        for wall in np.unique(np.sign(w.half_u), axis=0):
            own = (np.sign(w.half_u) == wall).all(axis=1)
            along, z = w.centres[own] @ wall, w.centres[own, 2]
            apart = abs(along[:, None] - along) >= width[own][:, None] + width[own]
            above = abs(z[:, None] - z) >= height[own][:, None] + height[own]
            assert (apart | above | np.eye(len(z), dtype=bool)).all()


@pytest.mark.parametrize("name", preset_names())
def test_numbers_run(name):
    city = preset(name)
    assert [b.building_id for b in city.buildings] == list(range(len(city.buildings)))
    ids = np.concatenate([b.windows.ids for b in city.buildings])
    assert (ids == np.arange(len(ids))).all()
    assert [box.media_id for box in city.media] == list(range(len(city.media)))


@pytest.mark.parametrize("name", SMALL_PRESETS)
def test_meshes_are_closed_boxes_that_face_outward(name):
    city = preset(name)
    for building in city.buildings:
        mesh = building.mesh
        quads = mesh.positions[mesh.indices.reshape(6, 4)]
        middle = mesh.positions.mean(axis=0)
        normal = np.cross(quads[:, 1] - quads[:, 0], quads[:, 3] - quads[:, 0])
        assert (((quads.mean(axis=1) - middle) * normal).sum(axis=1) > 0).all()
        edges = [(q[k], q[(k + 1) % 4]) for q in mesh.indices.reshape(6, 4) for k in range(4)]
        assert len(set(edges)) == 24 and all((b, a) in edges for a, b in edges)
        names = [city.materials[m].name for m in mesh.materials]
        assert names[4] == "roof" and all(name.startswith("facade_") for name in names[:4])
    assert city.materials[city.ground_material].name == "ground"


def test_texture_repeats_are_in_metres():
    city = preset("default")
    sizes = {"facade_plain": 1.0, "facade_concrete": 5.0, "facade_brick": 2.0, "facade_glass": 5.0}
    seen = set()
    for building in city.buildings:
        mesh, facade = building.mesh, city.materials[building.mesh.materials[0]]
        seen.add(facade.name)
        corners = mesh.texcoords.reshape(6, 4, 2)[:4] * sizes[facade.name]
        height = mesh.positions[:, 2].max()
        np.testing.assert_allclose(corners, np.tile([(0, 0), (10, 0), (10, height), (0, height)],
                                                    (4, 1, 1)))  # fmt: skip
        assert (facade.texture is None) == (facade.name == "facade_plain")
    assert seen == set(sizes)


@pytest.mark.parametrize("name", ["paper-4x4", "city-100x100"])
def test_same_parameters_same_bytes(name):
    assert pickle.dumps(generate(load_parameters(name))) == pickle.dumps(
        generate(load_parameters(name))
    )


def test_another_seed_another_city():
    one, other = (generate(load_parameters("default", {"seed": seed})) for seed in (1, 2))
    heights = [[b.mesh.positions[4, 2] for b in city.buildings] for city in (one, other)]
    assert heights[0] != heights[1]


def test_more_lit_windows_only_switch_on():
    p = CityParameters(seed=3)
    on = [np.concatenate([b.windows.light_on for b in
                          generate(dataclasses.replace(p, lit=lit)).buildings])
          for lit in (0, 0.3, 0.7, 1)]  # fmt: skip
    assert not on[0].any() and on[3].all()
    assert (on[1] <= on[2]).all()
    # 1280 draws: four standard deviations are 0.051
    assert abs(on[1].mean() - 0.3) < 0.052 and abs(on[2].mean() - 0.7) < 0.052


def test_colours_come_as_often_as_they_weigh():
    colours = ((1.0, 0.5, 0.25, 6.0), (1.0, 1.0, 1.0, 3.0), (0.5, 0.75, 1.0, 1.0))
    city = generate(CityParameters(window_colours=colours))
    drawn = np.concatenate([b.windows.colours for b in city.buildings])
    for *colour, weight in colours:
        share = (drawn == colour).all(axis=1).mean()
        assert abs(share - weight / 10) < 0.06  # four standard deviations
    assert (
        generate(CityParameters(window_colours=colours, seed=2))
        .buildings[0]
        .windows.colours[:20]
        .tolist()
        != drawn[:20].tolist()
    )


def test_nothing_can_be_changed_behind_anothers_back():
    city = preset("default")
    for array in (
        city.buildings[0].windows.centres,
        city.buildings[0].windows.light_on,
        city.buildings[0].mesh.positions,
        city.buildings[0].origin,
        city.media[0].lo,
        city.light_lists.window_ids,
    ):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0


def test_billboard_replaces_what_it_covers():
    city = preset("billboard")
    changed = [b for b in city.buildings if len(b.windows) != 80]
    assert [b.building_id for b in changed] == [2] and len(changed[0].windows) == 77
    w = changed[0].windows
    np.testing.assert_allclose(w.centres[-1], (0, -5.01, 24))
    assert (2 * w.half_u[-1]).tolist() == [10, 0, 0] and (2 * w.half_v[-1]).tolist() == [0, 0, 6]
    assert w.power[-1] == 1500 and w.light_on[-1]
    south = w.half_u[:-1, 0] > 0
    assert sorted(set(w.centres[:-1][south][:, 2])) == [5, 10, 15, 20]
    assert "billboard" in [camera.name for camera in city.cameras]


def test_parameters_are_kept_as_json_without_paths(tmp_path):
    import OpenImageIO as oiio  # noqa: N813

    image = oiio.ImageBuf(oiio.ImageSpec(8, 4, 3, "uint8"))
    image.write(str(tmp_path / "wall.png"))
    (tmp_path / "c.toml").write_text('facade_textures = ["wall.png"]')
    city = generate(load_parameters(tmp_path / "c.toml"))
    text = json.dumps(city.parameters)
    assert "wall.png" in text and str(tmp_path) not in text
    assert json.loads(text)["grid"] == [4, 4]
    assert str(tmp_path) not in str(city.materials)


def test_the_large_city_is_large():
    city = preset("city-100x100")
    assert len(city.buildings) == 10_000
    assert sum(len(b.windows) for b in city.buildings) == 1_200_000
    heights = np.array([b.mesh.positions[4, 2] for b in city.buildings])
    assert set(heights) == {30, 60} and (heights == 60).mean() == 0.5
