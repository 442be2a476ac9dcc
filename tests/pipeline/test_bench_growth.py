# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench growth``: slopes by hand, and a run on the smallest cities."""

from __future__ import annotations

import csv
import math
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import pytest
from conftest import Command

from nightcity.bench import growth as bench
from nightcity.bench.cost import run_measured
from nightcity.bench.growth_record import Growth, read_growth
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
    """In two runs: the second takes over what the first measured."""
    command = ("bench", "growth", "-o", tmp_path, "--methods", "surface,march", "--size", "64x36")
    left = tmp_path / "1x1" / "frame.exr"  # by a run that was killed
    left.parent.mkdir()
    left.write_bytes(bytes(1 << 20))
    nightcity(*command, "--grids", "1,3")
    first = cities(tmp_path)
    nightcity(*command, "--grids", "1,2,3")
    rows = cities(tmp_path)
    assert [row["grid"] for row in rows] == ["1", "2", "3"]
    assert first == [rows[0], rows[2]]
    for row in rows:
        assert int(row["buildings"]) == int(row["grid"]) ** 2
        assert all(float(value) > 0 for name, value in row.items()), row
    assert int(rows[2]["windows"]) > int(rows[0]["windows"])
    assert all(float(row["stage bytes"]) < 1 << 20 for row in rows)
    assert float(rows[2]["flat scene bytes"]) > float(rows[0]["flat scene bytes"])
    assert {path.name for path in tmp_path.iterdir()} == {
        "growth.json", "growth.csv", "growth.svg", "growth.png",
    }  # fmt: skip
    refused = nightcity(*command, "--preset", "paper-4x4", code=2)
    assert "city-100x100" in refused.stderr


def cities(folder: Path) -> list[dict[str, str]]:
    with (folder / "growth.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_goes_on_after_the_last_step(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stopped in a step, it has the ones before; a step that failed is not tried again."""
    done: list[str] = []
    stop = {"export"}

    def costs(command: Sequence[str | Path], limit: float) -> dict[str, float]:
        if command[0] in stop:
            raise KeyboardInterrupt
        if command[0] == "validate":
            raise NightcityError("took longer than 1 s")
        done.append(command[0])
        product = Path(command[-1])
        if command[0] == "export":
            product.mkdir()
            product = product / "scene.json"
        product.write_text("{}")
        return {"cpu s": 1.0, "memory bytes": 2.0}

    monkeypatch.setattr(bench, "_costs", costs)
    monkeypatch.setattr(bench, "_sizes", lambda work, scene: {"windows": 80.0})
    options = bench.GrowthOptions([1], "paper-4x4", [], "street", "8x8", 1.0)
    with pytest.raises(KeyboardInterrupt):
        bench.growth(tmp_path, options)
    stop.clear()
    bench.growth(tmp_path, options)
    bench.growth(tmp_path, options)
    assert done == ["generate", "export"]
    found = read_growth(tmp_path / "growth.json", options.kept)
    (city,) = found.cities
    assert (city["generate cpu s"], city["export memory bytes"], city["windows"]) == (1, 2, 80)
    assert found.left_out["validate"].grid == 1


def test_a_broken_record_is_said(tmp_path: Path) -> None:
    (tmp_path / "growth.json").write_text('{"cities": 3')
    with pytest.raises(NightcityError, match=r"growth\.json: cannot be read"):
        read_growth(tmp_path / "growth.json", {})
