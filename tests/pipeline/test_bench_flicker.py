# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench flicker``: its figures by hand, and a small shot."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from conftest import Command

from nightcity.bench.flicker import flicker_of


def test_an_error_that_stays_does_not_flicker() -> None:
    truth = np.array([[1.0, 2.0], [2.0, 4.0], [4.0, 8.0]])
    steady = flicker_of(1.1 * truth, truth)
    assert steady.median == pytest.approx(0.1)
    assert steady.rms_change == pytest.approx(0, abs=1e-12)


def test_changes_by_hand() -> None:
    truth = np.ones((3, 2))
    found = flicker_of(np.array([[1.0, 1.0], [1.2, 1.0], [1.2, 1.0]]), truth)
    assert found.rms_change == pytest.approx(0.1)  # sqrt(0.2^2 / 4)
    assert found.largest_change == pytest.approx(0.2)
    assert found.mean_change == pytest.approx(0.1)


def test_a_frame_that_sees_no_lit_haze_counts() -> None:
    truth = np.array([[1.0, 1.0], [0.0, 0.0], [1.0, 1.0]])
    found = flicker_of(truth + [[0, 0], [0.01, 0.01], [0, 0]], truth)
    assert found.largest_change == pytest.approx(1) == found.mean_change


def test_a_shot_of_three_frames(nightcity: Command, tmp_path: Path) -> None:
    stage = tmp_path / "shot.usda"
    nightcity(
        "generate", "--preset", "paper-2x2", "--frames", "3", "--time", "18:00-22:00", "-o", stage
    )
    small = ("--size", "96x54", "--frames", "1,3")
    said = nightcity("bench", "flicker", stage, "--methods", "march,gauss", *small).stdout
    rows = {row.split("|")[1].strip(): row.split("|")[2:-1] for row in said.splitlines()[2:]}
    median = {name: float(row[0].split()[0]) for name, row in rows.items()}
    assert median["gauss"] < 1 < median["march"]
    assert float(rows["gauss"][1].split()[0]) < 1
    assert "two" in nightcity("bench", "flicker", stage, "--frames", "3", code=2).stderr
