# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench ladder`` on the smallest city: signs and sizes that physics gives."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import Command

from nightcity.bench.ladder import Values, _row


def rows(text: str) -> dict[str, list[str]]:
    """Cells after the first of every row of every table, without those of heads."""
    lines = [line for line in text.splitlines() if line.startswith("| ")]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return {row[0]: row[1:] for row in cells if "%" in row[1]}


def share(cell: str) -> float:
    return float(cell.removesuffix(" %")) / 100


def test_a_row_by_hand() -> None:
    def values(*glow: float) -> Values:
        colour = np.repeat(np.array(glow)[:, None], 3, axis=1)
        return Values(colour, np.zeros_like(colour))

    # Bias 2.5 / 2 - 1 of the mean; sqrt((0.5^2 + 0^2) / 2) of each pixel's own value.
    assert _row("x", [(values(1.5, 1.0), values(1.0, 1.0))], "y") == "| x | +25.0 % | 35.4 % | y |"


def test_small_ladder(nightcity: Command) -> None:
    done = nightcity(
        *("bench", "ladder", "paper-1x1", "--extinctions", "0.02", "--cameras", "overview75"),
        *("--size", "96x53", "--pixels", "6", "--integrated-pixels", "1", "--samples", "1024"),
    )
    found = rows(done.stdout)
    assert len(found) == 10 + 11
    assert all(len(cells) in (4, 5) for cells in found.values())
    # Halves of the light of isotropic windows go into their own wall.
    assert -0.7 < share(found["isotropic instead of Lambertian"][0]) < -0.2
    near = [share(found[f"visible windows within {reach} m"][0]) for reach in (20, 30, 45)]
    assert near == sorted(near)
    assert near[-1] <= 0
    assert share(found["no visibility"][0]) > 0.1
    assert -0.3 < share(found["single instead of multiple"][0]) < -0.01
    assert share(found["black instead of lit surfaces"][0]) < 0
    # The more is in a model, the nearer it is to the richest.
    names = ["paper, exact: listed, none, isotropic", "single: all, full, pane"]
    names += ["all, full, pane, multiple"]
    errors = [share(found[name][1]) for name in names]
    assert errors[0] > errors[1] > errors[2] > 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("nonsense",), "neither a preset"),
        (("paper-1x1", "--pixels", "0"), "--pixels"),
        (("paper-1x1", "--samples", "1"), "--samples"),
        (("paper-1x1", "--extinctions", "-1"), "extinction"),
        (("paper-1x1", "--cameras", "attic"), "--cameras attic"),
    ],
)
def test_wrong_input_is_named(nightcity: Command, arguments: tuple[str, ...], message: str) -> None:
    assert message in nightcity("bench", "ladder", *arguments, code=2).stderr
