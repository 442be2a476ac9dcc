# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The chart: error statistics by hand, and a small chart made for real, killed and gone on with."""

from __future__ import annotations

import shutil
from pathlib import Path
from xml.etree import ElementTree

import matplotlib.pyplot as plt
import numpy as np
import pytest
from small_chart import CAMERA, EVERY_METHOD, make_small_chart, shared_chart, small_stage

from nightcity.chart import kept
from nightcity.chart.errors import error_statistics
from nightcity.chart.plot import front
from nightcity.chart.plot_labels import label_points, plain_logarithmic
from nightcity.chart.results import COLUMNS, Row, read_rows
from nightcity.chart.settings import FULL_POINTS, QUICK_POINTS
from nightcity.chart.shot import Size
from nightcity.errors import NightcityError, UsageError


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


def test_settings_are_as_many_as_promised() -> None:
    assert len(QUICK_POINTS) >= 12 and len({point.method for point in QUICK_POINTS}) >= 3
    assert len(FULL_POINTS) >= 25
    assert {point.method for point in FULL_POINTS} == {"march", "gauss", "field", "path"}
    for points in (QUICK_POINTS, FULL_POINTS):
        assert len({point.name for point in points}) == len(points)


def test_front_is_what_nothing_beats() -> None:
    points = [(1, 9), (2, 5), (3, 6), (4, 5), (5, 1)]
    rows: list[Row] = [{"ms": ms, "error": error} for ms, error in points]
    assert [row["ms"] for row in front(rows, "ms", "error")] == [1, 2, 5]


def test_a_gain_that_nobody_sees_is_no_front() -> None:
    rows: list[Row] = [{"ms": 1, "error": 9}, {"ms": 2, "error": 8.9}, {"ms": 3, "error": 8.7}]
    assert [row["ms"] for row in front(rows, "ms", "error")] == [1, 3]


def test_labels_leave_each_other_room() -> None:
    figure, axes = plt.subplots(figsize=(6, 3))
    axes.set(xscale="log", yscale="log", xlim=(1, 1000), ylim=(0.1, 100))
    plain_logarithmic(axes.xaxis)
    # Side by side, on top of each other, and at the right border.
    places = [(30.0, 5.0), (33.0, 5.0), (33.0, 5.2), (950.0, 5.0)]
    figure.draw_without_rendering()
    boxes = label_points(axes, [f"march {n}, steps outside" for n in range(4)], places)
    for i, box in enumerate(boxes):
        assert box.count_overlaps(boxes[:i]) == 0
        assert axes.get_window_extent().x0 <= box.x0 and box.x1 <= axes.get_window_extent().x1
    assert {"1", "2", "5"} <= {text.get_text() for text in axes.get_xticklabels()}
    plt.close(figure)


def test_size_names_one_that_divides() -> None:
    assert str(Size.parse("480x267").judged) == "160x89"
    with pytest.raises(UsageError, match="480x270"):
        Size.parse("481x269")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return shared_chart(tmp_path_factory)


@pytest.fixture(scope="module")
def rows(made: Path) -> dict[str, Row]:
    return {row["setting"]: row for row in read_rows(made / "results.csv")}


def test_every_row_is_whole(rows: dict[str, Row]) -> None:
    surface = rows.pop("surface frame")
    assert surface["numerical_centre_median"] is None
    for row in rows.values():
        assert not row["failure"]
        assert tuple(row) == COLUMNS
        assert all(row[name] is not None for name in COLUMNS), row["setting"]
        assert row["steady_frame_ms"] > 0 and row["rounds"] == 2


def test_errors_are_what_they_must_be(rows: dict[str, Row]) -> None:
    # More steps, less error: the march converges to the judge of its own model ...
    medians = [rows[f"march {n}"]["numerical_centre_median"] for n in (5, 25, 100)]
    assert medians[0] > medians[1] > medians[2]
    assert medians[2] < 1e-3
    # ... and not to the richest, whose light the paper's lists leave out.
    assert rows["march 100"]["total_centre_bias"] < -0.3
    # Paths of the full model have noise and no bias beyond it.
    path = rows["path 16, full"]
    assert abs(path["total_centre_bias"]) < 4 * path["mean_noise"]
    assert path["numerical_centre_bias"] == path["total_centre_bias"]
    # An image through pixel centres is off by what happens within pixels.
    assert rows["march 100"]["numerical_integrated_median"] > medians[2]
    assert path["total_flip"] > 0 and rows["march 100"]["numerical_flip"] < path["numerical_flip"]


def test_pictures_are_there(made: Path) -> None:
    stem = f"small.{CAMERA}"
    assert ElementTree.parse(made / f"{stem}.svg").getroot().tag.endswith("svg")
    assert (made / f"{stem}.png").read_bytes().startswith(b"\x89PNG")


def test_a_killed_chart_goes_on(
    made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = (made / "results.csv").read_bytes()
    shutil.copytree(made / "measured", tmp_path / "chart" / "measured")
    calls = []

    def refuse(*arguments: object) -> None:
        calls.append(arguments)
        raise NightcityError("nothing should be rendered anew")

    monkeypatch.setattr(kept, "run_renderer", refuse)
    monkeypatch.setattr(kept, "time_frames", refuse)
    make_small_chart(tmp_path, EVERY_METHOD)
    assert (tmp_path / "chart" / "results.csv").read_bytes() == before
    # Another renderer, or another scene, finds nothing of it.
    monkeypatch.setattr(kept.Kept, "renderer_hash", "another")
    with pytest.raises(NightcityError, match="anew"):
        make_small_chart(tmp_path, EVERY_METHOD)
    assert len(calls) == 1


def test_command_refuses_what_it_cannot_do(nightcity, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    stage = small_stage(tmp_path)
    assert "name a scene" in nightcity("chart", "-o", tmp_path / "c", code=2).stderr
    wrong = nightcity("chart", stage, "-o", tmp_path / "c", "--cameras", "moon", code=2).stderr
    assert "moon" in wrong and CAMERA in wrong
