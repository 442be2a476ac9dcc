# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The first chart: error statistics by hand, and a small chart made for real."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from conftest import Command

from nightcity.chart import speed_accuracy
from nightcity.chart.errors import error_statistics


def grey(values: list[float]) -> np.ndarray:
    return np.repeat(np.array(values)[:, None], 3, axis=1)


def test_error_statistics_by_hand() -> None:
    statistics = error_statistics(grey([1.1, 1.8, 4.0]), grey([1.0, 2.0, 4.0]))
    assert statistics.pixels == 3
    assert statistics.bias == pytest.approx(6.9 / 7 - 1)
    assert statistics.median == pytest.approx(0.1)
    assert statistics.max == pytest.approx(0.1)
    assert statistics.relative_rmse == pytest.approx(np.sqrt((0.01 + 0.01 + 0) / 3))


def test_dark_pixels_count_against_the_floor() -> None:
    # The median nonzero glow is 2, so that errors of darker pixels are relative to 0.02.
    statistics = error_statistics(grey([0.01, 2.0, 2.0]), grey([0.0, 2.0, 2.0]))
    assert statistics.max == pytest.approx(0.5)


def test_black_image_has_no_error() -> None:
    statistics = error_statistics(grey([0.0, 0.0]), grey([0.0, 0.0]))
    assert (statistics.bias, statistics.max) == (0, 0)


def test_missing_light_is_seen() -> None:
    reference = grey(list(np.linspace(1, 2, 100)))
    statistics = error_statistics(0.95 * reference, reference)
    assert statistics.bias == pytest.approx(-0.05)
    assert statistics.median == pytest.approx(0.05)


def test_small_chart(nightcity: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stage = tmp_path / "city.usda"
    nightcity("generate", "--preset", "paper-1x1", "-o", stage)
    small = replace(
        speed_accuracy.QUICK, size="96x53", rounds=2, repeats=2, pixels=60, reference_steps=2000
    )
    monkeypatch.setattr(speed_accuracy, "QUICK", small)
    paths = speed_accuracy.chart(stage, tmp_path / "chart", "overview75", quick=True)
    assert [path.name for path in paths] == [
        "results.csv",
        "speed-accuracy.svg",
        "speed-accuracy.png",
    ]
    with paths[0].open(newline="") as lines:
        rows = {row["setting"]: row for row in csv.DictReader(lines)}
    assert rows["surface frame"]["median"] == ""
    assert all(float(row["steady_frame_ms"]) > 0 for row in rows.values())
    for order in ("steps", "lights"):
        # More steps, less error: the march converges to the judge.
        medians = [float(rows[f"march-{n}, {order} outside"]["median"]) for n in (5, 25, 100)]
        assert medians[0] > medians[1] > medians[2]
        assert medians[2] < 1e-3
        assert int(rows[f"march-100, {order} outside"]["light_evaluations"]) > 0
    assert ElementTree.parse(paths[1]).getroot().tag.endswith("svg")
