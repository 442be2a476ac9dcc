# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Media boxes on the stage come back with the bits that they were given."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pxr import Usd, UsdGeom
from stage_city import lists_by_rule, media_row, small_city

from nightcity.stage.media import centre_and_half
from nightcity.stage.write import write_stage

MICROMETRE = 2.0**-20


def corners(stage: Usd.Stage) -> dict[int, np.ndarray]:
    """Lower and upper corners in double precision, as any reader of the stage computes them."""
    cache = UsdGeom.XformCache()
    found = {}
    for prim in stage.Traverse():
        if prim.GetTypeName() == "Cube":
            half = prim.GetAttribute("size").Get() / 2
            matrix = cache.GetLocalToWorldTransform(prim)
            points = [matrix.Transform((side * half,) * 3) for side in (-1, 1)]
            found[prim.GetAttribute("nightcity:mediaId").Get()] = np.array(points)
    return found


def awkward_edges() -> list[float]:
    """Thirds, tenths, sums that miss their neighbour by one bit, thin slices, far places."""
    near = [-1e4 / 3, -1 / 3, 0.0, 0.1, 0.1 + 0.2, 0.7, 1 / 3 + 1, 10.0, 10.1, 33.3333333, 1e3 / 7]
    return sorted({*near, 1e5 + 0.1, 1e5 + 1 / 3, 3e6 + 0.3, 3e6 + 1.7})


def test_neighbours_share_their_face_to_the_bit(tmp_path: Path) -> None:
    edges = awkward_edges()
    media = media_row(edges, 29.999)
    city = replace(small_city(), media=media)
    city = replace(city, light_lists=lists_by_rule(city.buildings, media))
    found = corners(Usd.Stage.Open(str(write_stage(city, tmp_path / "city.usda")[0])))
    for index in range(len(media) - 1):
        assert found[index][1][0] == found[index + 1][0][0]
        assert np.float32(found[index][1][0]) == np.float32(found[index + 1][0][0])
    for index, box in enumerate(media):
        assert found[index] == pytest.approx(np.array([box.lo, box.hi]), abs=MICROMETRE)


def test_neighbours_that_miss_by_rounding_meet() -> None:
    above, below = 0.1 + 0.2, 0.3
    assert above != below
    first = centre_and_half(np.zeros(3), np.full(3, above))
    second = centre_and_half(np.full(3, below), np.ones(3))
    assert (first[0] + first[1] == second[0] - second[1]).all()


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3, 1e6])
def test_centre_and_half_give_the_corners_exactly(scale: float) -> None:
    rng = np.random.default_rng(1)
    edges = np.sort(rng.uniform(-scale, scale, (1000, 2)), axis=1)
    edges[:, 1] += MICROMETRE
    rounded = np.round(edges / MICROMETRE) * MICROMETRE
    for lo, hi in rounded:
        centre, half = centre_and_half(np.full(3, lo), np.full(3, hi))
        assert (centre - half == lo).all() and (centre + half == hi).all()


def test_values_of_the_paper_are_kept_as_they_are(tmp_path: Path) -> None:
    city = small_city()
    found = corners(Usd.Stage.Open(str(write_stage(city, tmp_path / "city.usda")[0])))
    for box in city.media:
        assert (found[box.media_id] == [box.lo, box.hi]).all()


def test_attributes_and_sources(tmp_path: Path) -> None:
    city = small_city()
    stage = Usd.Stage.Open(str(write_stage(city, tmp_path / "city.usda")[0]))
    prim = stage.GetPrimAtPath("/City/Media/Group_0000/Box_0")
    values = {
        name: prim.GetAttribute(f"nightcity:{name}").Get()
        for name in ("mediaId", "extinction", "albedo", "reachScale")
    }
    assert values == pytest.approx(
        {"mediaId": 0, "extinction": 0.01, "albedo": 0.9, "reachScale": 1.5}
    )
    offsets, ids = city.light_lists.offsets, city.light_lists.window_ids
    listed = ids[offsets[0] : offsets[1]]
    assert list(prim.GetAttribute("nightcity:windowLights").Get()) == listed.tolist()
    assert {window // 4 for window in listed.tolist()} == {0, 1}
    sources = prim.GetRelationship("nightcity:windowLightSources").GetTargets()
    assert [str(path) for path in sources] == [
        f"/City/Buildings/Group_0000/Building_{number}/Windows" for number in (0, 1)
    ]


def test_haze_is_there_for_renderers_only(tmp_path: Path) -> None:
    stage = Usd.Stage.Open(str(write_stage(small_city(), tmp_path / "city.usda")[0]))
    box = UsdGeom.Imageable(stage.GetPrimAtPath("/City/Media/Group_0000/Box_0"))
    assert box.ComputePurpose() == "render"
