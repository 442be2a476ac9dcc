# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""A chart of the smallest city, for the tests of tables and page."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Sequence
from pathlib import Path

import pytest

from nightcity.chart import speed_accuracy
from nightcity.chart.measure import Extent
from nightcity.chart.settings import FULL, PAPER, Point, field, gauss, march, path
from nightcity.chart.speed_accuracy import ChartOptions, chart
from nightcity.chart.truth import Effort
from nightcity.city.generate import generate
from nightcity.city.parameters import load_parameters
from nightcity.stage.write import write_stage

CAMERA = "overview75"
EXTENT = Extent("96x54", 2, 40, 4, Effort(0.01, 256, 0.1, 16), 20_000)
POINTS = (
    *(march(steps, "steps") for steps in (5, 25)),
    *(march(steps) for steps in (5, 25, 100)),
    gauss(PAPER, 0.01),
    path(FULL, 16),
)
EVERY_METHOD = (*POINTS, field(0.1))


def small_stage(folder: Path) -> Path:
    """The paper's city of one building."""
    stage = folder / "small.usda"
    if not stage.is_file():
        write_stage(generate(load_parameters("paper-1x1")), stage)
    return stage


def make_small_chart(folder: Path, points: Sequence[Point] = POINTS) -> Path:
    """The chart's folder; one that was made before is gone on with."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(speed_accuracy, "QUICK", EXTENT)
        patch.setattr(speed_accuracy, "QUICK_POINTS", points)
        chart([small_stage(folder)], folder / "chart", ChartOptions([CAMERA], None, quick=True))
    return folder / "chart"


def shared_chart(factory: pytest.TempPathFactory) -> Path:
    """The chart of every method, made once for all test processes; read it, change only copies."""
    base = factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "small-chart"
    folder.mkdir(exist_ok=True)
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        made = folder / "chart"
        return made if (made / "index.html").is_file() else make_small_chart(folder, EVERY_METHOD)
