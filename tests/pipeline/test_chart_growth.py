# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The growth plot's series, and a small measured one."""

from __future__ import annotations

from pathlib import Path

import pytest
from small_chart import CAMERA, small_stage

from nightcity.chart import growth
from nightcity.chart.growth import SETTINGS, growth_shots, measure_growth, series, smaller_cities
from nightcity.chart.kept import Kept
from nightcity.chart.shot import Scene, Shot, Size
from nightcity.render import flat_scene


def test_growth_of_two_cities(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(growth, "SMALLER", ("paper-2x2",))
    cheap = ("surface frame", "march 25", "gauss 0.01, paper")
    monkeypatch.setattr(growth, "SETTINGS", {name: SETTINGS[name] for name in cheap})
    with flat_scene(small_stage(tmp_path)) as folder:
        shot = Shot(Scene("small", folder), CAMERA, Size(96, 54))
        shots = growth_shots(shot, smaller_cities(tmp_path))
        assert [str(each.size) for each in shots] == ["96x54", "32x18", "64x36", "128x72", "96x54"]
        grown = series(list(measure_growth(Kept(tmp_path / "kept", tmp_path), shots)), shot)
    assert set(grown) == {"pixels", "windows", "buildings", "media boxes"}
    for name in cheap:
        assert [point["x"] for point in grown["pixels"][name]] == [576, 2304, 5184, 9216]
        assert [point["x"] for point in grown["windows"][name]] == [80, 320]
        assert [point["x"] for point in grown["buildings"][name]] == [1, 4]
        assert [point["x"] for point in grown["media boxes"][name]] == [8, 21]
        assert all(point["steady_frame_ms"] > 0 for point in grown["pixels"][name])
