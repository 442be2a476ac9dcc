# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What a scene needs: recommendations by hand, and ``--model auto`` in an image's metadata."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest
from conftest import Command
from small_chart import CAMERA, small_stage

from nightcity.chart.frame_file import FrameFile
from nightcity.chart.measure import Measured, ShotResults
from nightcity.chart.needs import find_needs, recommend
from nightcity.chart.needs_text import as_html
from nightcity.chart.settings import FULL, LADDER, SINGLE, Point, field, gauss, path
from nightcity.chart.shot import Scene, Shot, Size
from nightcity.chart.truth import Values

SIZE = Size(30, 30)


def measured(point: Point, ratio: float, glow: np.ndarray) -> Measured:
    found = Measured(point, ratios=[ratio, ratio * 1.01])
    found.frame = FrameFile(glow, glow, None)
    found.timings = [_Timing(ratio), _Timing(ratio * 1.01)]  # type: ignore[list-item]
    return found


class _Timing:
    def __init__(self, steady_frame_ms: float) -> None:
        self.steady_frame_ms = steady_frame_ms


def results(settings: list[Measured], truth: np.ndarray) -> ShotResults:
    """Every pixel of a 30 x 30 image; single scattering is 0.85 of the full model."""
    y, x = np.mgrid[: SIZE.height, : SIZE.width]
    pixels = np.stack([x.ravel(), y.ravel()], axis=1)
    glow = truth[pixels[:, 1], pixels[:, 0]]
    share = {model.name: 1.0 if model == FULL else 0.85 for model in LADDER}
    centres = {name: Values(s * glow, np.zeros_like(glow)) for name, s in share.items()}
    shot = Shot(Scene("city", Path("city.scene")), "street", SIZE)
    return ShotResults(shot, pixels, pixels, [], settings, {}, centres)


@pytest.fixture
def truth() -> np.ndarray:
    random = np.random.default_rng(3)
    return np.repeat(random.uniform(1, 2, (SIZE.height, SIZE.width, 1)), 3, axis=2)


def test_the_cheapest_that_holds_is_recommended(truth: np.ndarray) -> None:
    single = 0.85 * truth
    settings = [
        measured(field(0.1), 1, 1.05 * single),
        measured(field(0.01), 2, 1.005 * single),
        measured(gauss(SINGLE, 0.01), 50, single),
    ]
    found = results(settings, truth)
    choices = [recommend(found, tolerance, SINGLE).chosen for tolerance in (0.1, 0.02, 0.001)]
    assert [chosen and chosen.point.name for chosen in choices] == [
        "field 0.1",
        "field 0.01",
        "gauss 0.01, single",
    ]
    held = recommend(found, 0.02, SINGLE)
    assert held.error == pytest.approx(0.005) and held.cheaper == ()
    assert "--tolerance" in held.options and "field" in held.options


def test_paths_are_foretold_where_nothing_else_is_the_full_model(truth: np.ndarray) -> None:
    noise = np.random.default_rng(4).normal(0, 0.2, truth.shape[:2])
    settings = [
        measured(field(0.01), 2, 0.85 * truth),
        measured(path(FULL, 16), 100, truth * (1 + noise[..., None])),
    ]
    found = recommend(results(settings, truth), 0.04, FULL)
    # 95 of 100 pixels are within 0.39; a tenth of that asks for 96 times the paths, and some more.
    assert found.chosen is None and found.samples is not None
    assert 16 * 96 < found.samples < 16 * 96 * 1.6
    assert found.frame_ms == pytest.approx(100.5 * found.samples / 16)


def test_switches_say_what_they_change(truth: np.ndarray) -> None:
    settings = [measured(field(0.01), 2, 0.84 * truth), measured(path(FULL, 4), 9, 1.3 * truth)]
    found = results(settings, truth)
    asked = []

    def render(pixels: np.ndarray, options: Sequence[str]) -> np.ndarray:
        asked.append(options[options.index("--samples") + 1])
        return 1.05 * truth[pixels[:, 1], pixels[:, 0]]

    needs = find_needs(found, render)
    lit = needs.changes[-1]
    assert lit.switch.richer == FULL and lit.bias == pytest.approx(-0.15)
    assert lit.beyond == 1 and lit.p95 == pytest.approx(0.15)
    assert needs.changes[0].bias == 0
    text = as_html(needs, Shot(Scene("a<b", Path("x")), "street", SIZE))
    assert "lit surfaces (-15 %)" in text and "a<b" not in text
    # 30 % too much asks for 47, 1170 and 18720 paths: the last are too many to look at.
    assert [int(samples) // 10 for samples in asked] == [4, 117]
    assert "it holds: 5 %" in text and "it MISSES: 5 %" in text and "Not rendered." in text
    # Nothing charted holds single scattering to 0.5 %: gauss is named, as not judged here.
    assert "--model single --method gauss --tolerance 0.005" in text and "neither timed" in text


def test_auto_chooses_and_says_so(nightcity: Command, tmp_path: Path) -> None:
    stage, image = small_stage(tmp_path), tmp_path / "auto.exr"
    render = ("render", stage, "--camera", CAMERA, "--size", "48x27", "--model", "auto")
    done = nightcity(*render, "--against", "single", "--tolerance", "0.02", "-o", image)
    assert "note: auto, 2 % in 95 of 100 pixels: single by" in done.stderr
    file = OpenImageIO.ImageInput.open(str(image))
    spec = file.spec()
    file.close()
    assert spec.getattribute("nightcity:choice").startswith("auto, 2 %")
    assert spec.getattribute("nightcity:emitter") == "pane"


def test_auto_refuses_what_it_decides(nightcity: Command, tmp_path: Path) -> None:
    render = ("render", small_stage(tmp_path), "--model", "auto", "-o", tmp_path / "a.exr")
    assert "--tolerance" in nightcity(*render, code=2).stderr
    more = ("--tolerance", "0.1", "--method", "march")
    assert "--method: --model auto chooses it" in nightcity(*render, *more, code=2).stderr
    assert "0.0001 to 1" in nightcity(*render, "--tolerance", "7", code=2).stderr
