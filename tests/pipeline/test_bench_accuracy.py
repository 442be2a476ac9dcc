# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench accuracy`` on the smallest city, and what it says of wrong input."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from conftest import Command

from nightcity.bench.accuracy import Line, compare
from nightcity.bench.judge import Keeper, View, choose_pixels
from nightcity.bench.scenes import open_scene
from nightcity.chart.runs import PixelTable
from nightcity.errors import SceneError

SMALL = ("--size", "96x53", "--pixels", "12", "--cameras", "overview75", "--emitters", "isotropic")


def table(glow: np.ndarray, error: float | None = None) -> PixelTable:
    colour = np.repeat(glow[:, None], 3, axis=1)
    pixels = np.zeros((len(glow), 2), dtype=np.int64)
    errors = None if error is None else np.full_like(colour, error)
    return PixelTable(pixels, colour, errors)


GAUSS = Line("gauss", "gauss 0.01", (), 0.01)
PATH = Line("path", "path", (), None)


@pytest.mark.parametrize(("count", "share"), [(999, "p95"), (1000, "p99")])
def test_the_tolerance_is_held_against_a_percentile(count: int, share: str) -> None:
    truth = np.linspace(1, 2, count)
    found = table(1.002 * truth)
    cells, good = compare(GAUSS, found, table(truth).glow)
    assert good
    assert cells == [str(count), "0.2 %", "0.2 %", "0.2 %"] + [
        "0.2 %" if share == "p99" else "",
        "0.2 %",
        "0.2 %",
        f"{share} within 1 %",
    ]


def test_a_missed_tolerance_is_said() -> None:
    truth = np.linspace(1, 2, 1000)
    value = truth.copy()
    value[:15] *= 1.02  # 1.5 % of the pixels
    cells, good = compare(GAUSS, table(value), table(truth).glow)
    assert not good
    assert cells[-1] == "p99 MISSES 1 %"


@pytest.mark.parametrize(
    ("estimate", "says"),
    [
        (0.01, "estimate holds: exceeded in 0 %, median x 5"),
        (0.001, "estimate MISSES: exceeded in 100.0 %, median x 0.5"),
        (0.05, "estimate MISSES: exceeded in 0 %, median x 25"),
    ],
)
def test_an_estimate_is_held_against_the_error(estimate: float, says: str) -> None:
    truth = np.linspace(1, 2, 1000)
    found = replace(table(1.002 * truth), estimate=np.full(1000, estimate))
    cells, good = compare(GAUSS, found, table(truth).glow)
    assert cells[-1] == f"p99 within 1 %; {says}"
    assert good == ("holds" in says)


def test_path_is_held_against_its_own_error() -> None:
    truth = np.full(100, 2.0)
    assert compare(PATH, table(truth + 0.01, 0.02), table(truth).glow)[1] is False  # 5 sigma
    assert compare(PATH, table(truth + 0.001, 0.02), table(truth).glow)[1] is True


def test_darkness_is_no_success() -> None:
    assert compare(GAUSS, table(np.zeros(5)), table(np.zeros(5)).glow)[1] is False


def test_small_table_and_kept_results(nightcity: Command, tmp_path: Path) -> None:
    judged = tmp_path / "judged"
    command = ("bench", "accuracy", "paper-1x1", *SMALL, "--tolerances", "0.01", "--judged", judged)
    done = nightcity(*command, "--methods", "reference,path", "--samples", "40000")
    rows = [line for line in done.stdout.splitlines() if line.startswith("| paper-1x1")]
    assert len(rows) == 2
    assert "p95 within 1 %" in rows[0]
    assert "agrees: mean ratio" in rows[1]
    assert "2 of 2 lines meet their bar" in done.stdout
    assert len(list(judged.iterdir())) == 1
    again = nightcity(*command, "--methods", "reference")
    assert "12 of 12 pixels" not in again.stderr  # nothing was judged anew


def test_all_orders_of_the_field_beside_paths(nightcity: Command, tmp_path: Path) -> None:
    command = ("bench", "accuracy", "paper-1x1", *SMALL, "--methods", "field")
    orders = ("--scattering", "multiple", "--surfaces", "lit", "--samples", "512")
    # Twelve pixels are too few for what the field estimates of its error.
    done = nightcity(*command, *orders, "--tolerances", "0.1", code=1)
    (row,) = (line for line in done.stdout.splitlines() if line.startswith("| paper-1x1"))
    assert "p95 within 10.0 %" in row
    assert "the truth's noise" in row


def test_a_kept_result_is_taken_and_counts(tmp_path: Path) -> None:
    view = View(open_scene("paper-1x1", tmp_path), "overview75", "96x53")
    pixels = choose_pixels(view, 8, tmp_path)
    keeper = Keeper(tmp_path / "kept")
    options = ("--model", "paper", "--method", "reference", "--tolerance", "0.1")
    first = keeper.measure(view, pixels, options, tmp_path)
    np.testing.assert_array_equal(first.pixels, pixels)
    (file,) = keeper.folder.iterdir()
    head, *rows = file.read_text().splitlines()
    # Planted, to see where the values come from.
    planted = [",".join(["0"] * len(head.split(",")[2:])) for _ in rows]
    places = [",".join(row.split(",")[:2]) for row in rows]
    lines = [f"{place},{zeros}" for place, zeros in zip(places, planted, strict=True)]
    file.write_text("\n".join([head, *lines]) + "\n")
    assert first.glow.sum() > 0
    assert keeper.measure(view, pixels, options, tmp_path).glow.sum() == 0
    file.write_text("\n".join([head, *rows[:-1]]) + "\n")
    with pytest.raises(SceneError, match="holds other pixels"):
        keeper.measure(view, pixels, options, tmp_path)
    # Other pixels or options are another result.
    keeper.measure(view, pixels[:-1], options, tmp_path)
    keeper.measure(view, pixels, (*options[:-1], "0.2"), tmp_path)
    assert len(list(keeper.folder.iterdir())) == 3


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("nonsense",), "neither a preset"),
        (("paper-1x1", "--methods", "guess"), "--methods guess: there are"),
        (("paper-1x1", "--emitters", "lamp"), "--emitters lamp: there are"),
        (("paper-1x1", "--cameras", "attic"), "--cameras attic: the cameras of paper-1x1 are"),
        (("paper-1x1", "--pixels", "0"), "--pixels"),
        (("paper-1x1", "--tolerances", "2"), "--tolerances"),
        (("paper-1x1", "--methods", "path", "--scattering", "multiple"), "--methods field"),
        (("paper-1x1", "--methods", "field", "--surfaces", "lit"), "--scattering multiple only"),
        (("--town", "nowhere.json"), "no such CityJSON file"),
    ],
)
def test_wrong_input_is_named(nightcity: Command, arguments: tuple[str, ...], message: str) -> None:
    assert message in nightcity("bench", "accuracy", *arguments, code=2).stderr
