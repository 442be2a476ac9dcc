# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench growth``: slopes by hand, and a run on the smallest cities."""

from __future__ import annotations

import csv
import math
import sys
import time
from pathlib import Path

import pytest
from conftest import Command

from nightcity.bench.cost import run_measured
from nightcity.bench.growth import Growth
from nightcity.errors import NightcityError


def test_slopes() -> None:
    """Start-up time at the small end does not count; a step that stopped early has no slope."""
    cities = [
        {"windows": w, "a s": 7.0 if w < 100 else 0.02 * w**1.5, "b bytes": 3.0 * w}
        for w in (10, 40, 100, 400, 900)
    ]
    for city in cities[2:]:
        del city["b bytes"]
    found = Growth(cities)
    assert found.slope("a s") == pytest.approx(1.5)
    assert math.isnan(found.slope("b bytes"))
    assert found.columns(" s") == ["a s"]


def test_cost_of_a_process() -> None:
    """What the measuring process holds itself is not counted."""
    held = b"1" * (700 << 20)
    code = "b = bytearray(300 << 20)\nfor i in range(0, len(b), 4096): b[i] = 1\nwhile True:\n"
    code += " import time\n if time.process_time() > 0.5: break"
    cost = run_measured([sys.executable, "-c", code])
    assert 0.5 <= cost.cpu_seconds < 5 and 300 << 20 < cost.memory < 600 << 20
    del held
    with pytest.raises(NightcityError, match="no such thing"):
        run_measured([sys.executable, "-c", "raise SystemExit('no such thing')"])
    start = time.monotonic()
    with pytest.raises(NightcityError, match=r"longer than 0\.5 s"):
        run_measured([sys.executable, "-c", "import time; time.sleep(60)"], 0.5)
    assert time.monotonic() - start < 20


def test_small_growth(nightcity: Command, tmp_path: Path) -> None:
    nightcity(
        *("bench", "growth", "-o", tmp_path, "--grids", "1,2,3", "--methods", "surface,march"),
        *("--size", "64x36"),
    )
    with (tmp_path / "growth.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["grid"] for row in rows] == ["1", "2", "3"]
    for row in rows:
        assert int(row["buildings"]) == int(row["grid"]) ** 2
        assert all(float(value) > 0 for name, value in row.items()), row
    assert int(rows[2]["windows"]) > int(rows[0]["windows"])
    assert float(rows[2]["flat scene bytes"]) > float(rows[0]["flat scene bytes"])
    assert {path.name for path in tmp_path.iterdir()} == {
        "growth.csv", "growth.svg", "growth.png",
    }  # fmt: skip
