# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench paper`` on small frames, and what stands in the table of methods."""

from __future__ import annotations

from conftest import Command

from nightcity.bench.in_turn import InTurn
from nightcity.bench.methods import march
from nightcity.chart.runs import Timing


def test_in_turn_takes_the_median_of_the_rounds() -> None:
    timings = [Timing("device", 9.0, ms, 0.0, 0, 0, {"march": ms / 2}) for ms in (4.0, 10.0, 6.0)]
    measured = InTurn(timings)
    assert (measured.steady_ms, measured.spread_ms) == (6.0, 6.0)
    assert (measured.pass_ms("march"), measured.pass_ms("glow")) == (3.0, 0.0)


def test_marches_have_names_of_their_own() -> None:
    every = {march(steps, order) for steps in (5, 25) for order in ("steps", "lights")}
    assert len(every) == len({setting.name for setting in every}) == 4


def test_paper_table(nightcity: Command) -> None:
    small = ("--size", "48x27", "--rounds", "1", "--tolerance", "0.1")
    said = nightcity("bench", "paper", "steps", *small).stdout
    rows = {row.split("|")[1].strip(): row.split("|")[2:-1] for row in said.splitlines()[5:]}
    assert list(rows) == ["5", "25", "40", "100"]
    assert rows["25"][0].split() == ["9.2", "(1.00)"]  # the paper's 109 frames a second
    assert rows["5"][0].split() == ["5.1", "(0.55)"]
    assert all(column.endswith("(1.00) ") for column in rows["25"])
    assert float(rows["100"][1].split()[0]) > float(rows["5"][1].split()[0])


def test_unknown_table_is_named(nightcity: Command) -> None:
    assert "steps, coverage, grid" in nightcity("bench", "paper", "table1", code=2).stderr
    assert "--rounds 0" in nightcity("bench", "paper", "--rounds", "0", code=2).stderr
