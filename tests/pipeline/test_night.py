# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The night: windows that go on and off, cameras that move, from parameters to the flat scene."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from export_maker import Scene
from pxr import Usd

from nightcity.city.generate import generate
from nightcity.city.model import Building, City
from nightcity.city.night import Night, night_of, with_night
from nightcity.city.parameters import load_parameters
from nightcity.errors import SceneError, UsageError
from nightcity.export.export_stage import export_stage
from nightcity.stage.check_city import check_city
from nightcity.stage.validate import validate_stage
from nightcity.stage.write import write_stage

FRAMES = 33  # a quarter of an hour each
EVENING = {"time": "18:00-02:00", "frames": FRAMES}


def states(building: Building, frames: int = FRAMES) -> np.ndarray:
    """(frames, windows) by the definition of Windows.switches, one after the other."""
    state, rows = building.windows.light_on.copy(), []
    for frame in range(1, frames + 1):
        for row, at in building.windows.switches:
            if at == frame:
                state[row] = not state[row]
        rows.append(state.copy())
    return np.array(rows)


@pytest.fixture(scope="module")
def city() -> City:
    return generate(load_parameters("mixed-6x6", EVENING | {"lit": 1.0}))


@pytest.fixture(scope="module")
def use() -> dict[bool, np.ndarray]:
    """Windows of homes (False) and of offices (True) over the frames."""
    still = generate(load_parameters("mixed-6x6", {"lit": 1.0})).buildings
    night = night_of("18:00-02:00", FRAMES, 0.0, 6)
    made = {share > 0: with_night(still, replace(night, offices=share)) for share in (0.0, 1.0)}
    return {k: np.concatenate([states(b) for b in v], axis=1) for k, v in made.items()}


@pytest.mark.parametrize(
    ("text", "start", "end"),
    [("18:00-02:00", 18, 26), ("12:00-11:59", 12, 35 + 59 / 60), ("00:30-6:00", 24.5, 30)],
)
def test_times(text: str, start: float, end: float) -> None:
    night = night_of(text, 9, 0.3, 1)
    assert (night.start, night.end) == pytest.approx((start, end))
    assert load_parameters("paper-1x1", {"time": text, "frames": 2}).time == text


@pytest.mark.parametrize(
    "text", ["18-2", "24:00-02:00", "18:60-19:00", "11:00-13:00", "20:00-20:00"]
)
def test_times_that_are_none(text: str) -> None:
    with pytest.raises(UsageError, match="time"):
        load_parameters("paper-1x1", {"time": text, "frames": 2})
    with pytest.raises(UsageError, match="frames"):
        load_parameters("paper-1x1", {"time": "18:00-02:00"})


def test_frames_of_hours() -> None:
    night = Night(18, 26, 9, 0.3, 1)
    hours = np.array([-np.inf, 18, 18.01, 19, 25.5, 26, 26.01, np.inf])
    assert night.frame_of(hours).tolist() == [1, 1, 2, 2, 9, 9, 10, 10]


def test_homes_go_to_sleep_and_offices_go_home(use: dict[bool, np.ndarray]) -> None:
    home, office = (use[kind].mean(axis=1) for kind in (False, True))
    hour = 18 + np.arange(FRAMES) / 4
    assert office[0] > 0.6 > home[0] > 0.3  # at six
    assert home[hour == 20.5][0] > 0.6 > 0.3 > office[hour == 20.5][0]
    assert home[-1] < 0.05 and 0.02 < office[-1] < 0.2  # at two: stairs and all-nighters
    changes = (np.diff(use[False].astype(int), axis=0) != 0).sum(axis=0)
    assert 1.5 < np.median(changes) < 5


def test_windows_of_one_stairwell_go_together(city: City) -> None:
    """On every building one column of windows of one face is always alike."""
    for building in city.buildings:
        state = states(building)
        place = np.round(building.windows.centres[:, :2], 2)
        columns = np.unique(place, axis=0, return_inverse=True)[1]
        alike = [(state[:, columns == c].T == state[:, columns == c][:, 0]).all()
                 for c in range(columns.max() + 1)]  # fmt: skip
        assert 1 <= sum(alike) < len(alike)


def test_dark_windows_stay_dark() -> None:
    half = generate(load_parameters("mixed-6x6", {"lit": 0.4}))
    night = night_of("18:00-02:00", FRAMES, 0.3, 6)
    for before, after in zip(half.buildings, with_night(half.buildings, night), strict=True):
        assert not states(after)[:, ~before.windows.light_on].any()


def test_buildings_have_streams_of_their_own(city: City) -> None:
    """The night of a building does not depend on the others, nor on the frame rate."""
    still = generate(load_parameters("mixed-6x6", {"lit": 1.0})).buildings[7]
    fine = night_of("18:00-02:00", 4 * (FRAMES - 1) + 1, 0.3, 6)
    (alone,) = with_night([still], fine)
    assert (states(alone, fine.frames)[::4] == states(city.buildings[7])).all()
    (other,) = with_night([still], replace(fine, seed=7))
    assert (states(other, fine.frames) != states(alone, fine.frames)).any()


def test_the_night_comes_through_stage_and_export(city: City, tmp_path: Path) -> None:
    write_stage(city, tmp_path / "a.usda")
    assert [str(finding) for finding in validate_stage(tmp_path / "a.usda")] == []
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (1, FRAMES)
    export_stage(tmp_path / "a.usda", tmp_path / "s")
    scene = Scene(tmp_path / "s")
    assert not scene.notes
    state = (scene["window"]["flags"] & 1).astype(bool)
    expected = np.concatenate([states(building) for building in city.buildings], axis=1)
    ids = np.concatenate([building.windows.ids for building in city.buildings])
    assert (scene["window"]["window_id"] == ids).all()
    for frame in range(1, FRAMES + 1):
        events = scene["window_event"][scene["window_event"]["frame"] == frame]
        assert (state[events["window"]] != events["on"]).all()  # nothing said twice
        state[events["window"]] = events["on"]
        assert (state == expected[frame - 1]).all()


def test_moving_cameras(city: City, tmp_path: Path) -> None:
    write_stage(city, tmp_path / "a.usda")
    export_stage(tmp_path / "a.usda", tmp_path / "s")
    scene = Scene(tmp_path / "s")
    tracks = {
        camera["name"]: scene["camera_frame"][camera["first"] :][: camera["count"]]
        for camera in scene.manifest["cameras"]
    }
    assert {name for name, track in tracks.items() if len(track) > 1} == {"flight", "drive"}
    for name, still in (("flight", "overview75"), ("drive", "street")):
        assert len(tracks[name]) == FRAMES
        assert tracks[name][0] == tracks[still][0]
    step = np.linalg.norm(np.diff(tracks["drive"]["position"], axis=0), axis=1)
    np.testing.assert_allclose(step, 0.5, rtol=1e-5)
    target = np.array(next(c.target for c in city.cameras if c.name == "flight"))
    arm = tracks["flight"]["position"] - target
    np.testing.assert_allclose(np.linalg.norm(arm, axis=1), np.linalg.norm(arm[0]), rtol=1e-6)
    angle = np.unwrap(np.arctan2(arm[:, 1], arm[:, 0]))
    np.testing.assert_allclose(np.degrees(np.diff(angle)), 0.25, rtol=1e-3)


@pytest.mark.parametrize(
    "switches", [[(0, 1)], [(0, FRAMES + 1)], [(9999, 2)], [(-1, 2)], [(1, 2), (0, 2)]]
)
def test_switches_that_do_not_fit(city: City, switches: list) -> None:
    first, *others = city.buildings
    windows = replace(first.windows, switches=np.array(switches))
    with pytest.raises(SceneError, match=r"building 0: windows\.switches"):
        check_city(replace(city, buildings=(replace(first, windows=windows), *others)))
