# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Framing: a box fills the share of the frame's height that was asked for."""

from __future__ import annotations

import numpy as np
import pytest

from nightcity.city.cameras import frame_box, frame_height_share, look_along, overview_cameras
from nightcity.city.model import Camera

PAPER_4X4 = (-45.0, -45.0, 0.0), (45.0, 45.0, 30.0)


def test_share_of_a_face_seen_head_on():
    """A face 4 m high at distance 10 in a 90 degree frame, 20 m high there, fills a fifth."""
    camera = Camera("c", (0.0, -10.0, 2.0), (0.0, 0.0, 2.0), 90.0)
    assert frame_height_share(camera, (-1, 0, 0), (1, 50, 4)) == pytest.approx(0.2, rel=1e-12)


def test_share_behind_the_camera_is_infinite():
    camera = Camera("c", (0.0, -10.0, 2.0), (0.0, 0.0, 2.0), 90.0)
    assert frame_height_share(camera, (-1, -20, 0), (1, 5, 4)) == float("inf")


def test_the_paper_city_keeps_the_papers_cameras():
    cameras = {camera.name: camera for camera in overview_cameras(*PAPER_4X4)}
    assert cameras["overview75"] == Camera("overview75", (95, -125, 62), (0, 0, 6), 33.141)
    assert cameras["far25"] == Camera("far25", (300, -390, 150), (0, 0, 8), 27.79)


@pytest.mark.parametrize(
    "half, height, centre",
    [(15, 30, (0, 0)), (45, 60, (300, -900)), (1005, 60, (0, 0)), (4, 400, (7, 7))],
)
def test_every_overview_fills_its_share_along_the_papers_line_of_sight(half, height, centre):
    lo = np.array([centre[0] - half, centre[1] - half, -2.0])
    hi = np.array([centre[0] + half, centre[1] + half, height - 2.0])
    for camera in overview_cameras(lo, hi, centre):
        share = int("".join(filter(str.isdigit, camera.name))) / 100
        assert frame_height_share(camera, lo, hi) == pytest.approx(share, abs=5e-4)
        sight = np.subtract(camera.position, camera.target)
        paper = (300, -390, 142) if camera.name == "far25" else (95, -125, 56)
        np.testing.assert_allclose(np.cross(sight, paper), 0, atol=1e-8 * sight @ sight)
        assert sight @ paper > 0


def test_frame_box_solves_to_rounding():
    camera = frame_box(
        "c", *PAPER_4X4, share=0.4, towards_eye=(1, 1, 1), target=(0, 0, 5), vertical_fov_degrees=50
    )
    assert frame_height_share(camera, *PAPER_4X4) == pytest.approx(0.4, rel=1e-12)


@pytest.mark.parametrize("share", [0.0, -1.0, float("nan"), float("inf")])
def test_frame_box_refuses_an_impossible_share(share):
    with pytest.raises(ValueError, match="camera c: no distance"):
        frame_box(
            "c",
            *PAPER_4X4,
            share=share,
            towards_eye=(1, 1, 1),
            target=(0, 0, 5),
            vertical_fov_degrees=50,
        )


def test_frame_box_refuses_an_empty_box():
    with pytest.raises(ValueError, match="no distance"):
        frame_box(
            "c",
            (0, 0, 0),
            (0, 0, 0),
            share=0.5,
            towards_eye=(1, 1, 1),
            target=(0, 0, 0),
            vertical_fov_degrees=50,
        )


def test_look_along():
    assert look_along("c", (1, 2, 3), (0, 2, 0), 60) == Camera("c", (1, 2, 3), (1, 12, 3), 60)
