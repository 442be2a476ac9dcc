# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What a scene needs: recommendations by hand, and ``--model auto`` in an image's metadata."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest
from conftest import Command
from small_chart import CAMERA, small_stage

from nightcity.chart.frame_file import FrameFile
from nightcity.chart.measure import Measured, ShotResults
from nightcity.chart.needs import find_needs
from nightcity.chart.needs_text import as_html
from nightcity.chart.recommend import recommend
from nightcity.chart.recommendations import write_recommendations
from nightcity.chart.runs import PixelTable, Timing
from nightcity.chart.settings import (
    FULL,
    ISOTROPIC,
    LADDER,
    LAMBERTIAN,
    SINGLE,
    UNOCCLUDED,
    Point,
    field,
    gauss,
    path,
)
from nightcity.chart.shot import Scene, Shot, Size
from nightcity.chart.truth import Effort, Values

SIZE = Size(30, 30)


def measured(
    point: Point,
    ratio: float,
    glow: np.ndarray,
    error: np.ndarray | None = None,
    bake_ms: float = 0.0,
) -> Measured:
    found = Measured(point, ratios=[ratio, ratio * 1.01])
    found.frame = FrameFile(glow, glow, error)
    found.timings = [Timing("", 0, share * ratio, bake_ms, 0, 0, {}) for share in (1, 1.01)]
    return found


def results(settings: list[Measured], truth: np.ndarray, every: int = 1) -> ShotResults:
    """Every so many pixels of a 30 x 30 image; single scattering is 0.85 of the full model."""
    y, x = np.mgrid[: SIZE.height, : SIZE.width]
    pixels = np.stack([x.ravel(), y.ravel()], axis=1)[::every]
    glow = truth[pixels[:, 1], pixels[:, 0]]
    share = {model.name: 1.0 if model == FULL else 0.85 for model in LADDER}
    centres = {name: Values(s * glow, np.zeros_like(glow)) for name, s in share.items()}
    shot = Shot(Scene("city", Path("city.scene")), "street", SIZE)
    return ShotResults(shot, pixels, pixels, [], settings, {}, centres)


@pytest.fixture
def truth() -> np.ndarray:
    random = np.random.default_rng(3)
    return np.repeat(random.uniform(1, 2, (SIZE.height, SIZE.width, 1)), 3, axis=2)


class Looks:
    """Renders paths with the error given, of pixels whose truth it knows; keeps what it was
    asked for."""

    def __init__(self, truth: np.ndarray, error: float, most: int) -> None:
        self.truth_image, self.error, self.most = truth, error, most
        self.effort = Effort(0.01, 512, 0.1, 32)
        self.samples: list[int] = []

    def render(self, pixels: np.ndarray, options: Sequence[str]) -> PixelTable:
        samples = int(options[options.index("--samples") + 1])
        self.samples.append(samples)
        glow = self.truth_image[pixels[:, 1], pixels[:, 0]]
        sigma = self.error / np.sqrt(samples) * glow
        random = np.random.default_rng(len(self.samples))
        return PixelTable(pixels, glow + sigma * random.normal(size=(len(glow), 1)), sigma)

    def truth(self, model: object, pixels: np.ndarray, samples: int) -> Values:
        raise AssertionError("the truth has no noise here")


def test_the_cheapest_that_holds_is_recommended(truth: np.ndarray) -> None:
    single = 0.85 * truth
    settings = [
        measured(field(0.1), 1, 1.05 * single),
        measured(field(0.01), 2, 1.005 * single),
        measured(gauss(SINGLE, 0.01), 50, single),
    ]
    found = results(settings, truth)
    look = Looks(truth, 0, 0)
    choices = [recommend(found, tolerance, SINGLE, look).chosen for tolerance in (0.1, 0.02, 0.001)]
    assert [chosen and chosen.point.name for chosen in choices] == [
        "field 0.1",
        "field 0.01",
        "gauss 0.01, single",
    ]
    held = recommend(found, 0.02, SINGLE, look)
    assert held.error == pytest.approx(0.005) and held.cheaper == () and held.pixels == 450
    assert "--tolerance" in held.options and "field" in held.options


def test_a_cheaper_setting_that_holds_is_named(truth: np.ndarray) -> None:
    # One pixel in 40 is off: within 5 %, but on half of the pixels that is not sure.
    off = np.where(np.random.default_rng(5).uniform(size=truth.shape[:2]) < 1 / 40, 1.3, 1.0)
    settings = [
        measured(field(0.1), 1, 0.85 * truth * off[..., None]),
        measured(field(0.01), 2, 0.85 * truth),
    ]
    few = results(settings, truth, every=20)
    found = recommend(few, 0.02, SINGLE, Looks(truth, 0, 0))
    assert found.chosen and found.chosen.point.name == "field 0.01"
    assert found.cheaper == ("field 0.1",)


def test_paths_are_foretold_and_held_against_unseen_pixels(truth: np.ndarray) -> None:
    sigma = 1.6  # of one path
    settings = [
        measured(field(0.01), 2, 0.85 * truth),
        # The chart's few paths know half of their noise.
        measured(path(FULL, 16), 100, 1.5 * truth, error=0.5 * sigma / 4 * truth),
    ]
    look = Looks(truth, sigma, most=500_000)
    found = recommend(results(settings, truth), 0.1, FULL, look)
    # Two sigmas within 10 % ask for about 1,000 paths; sureness and prudence for twice as many.
    assert found.chosen is None and found.samples is not None
    assert 1000 < found.samples < 2500
    assert found.frame_ms == pytest.approx(100.5 * found.samples / 16)
    assert found.error is not None and 0.03 < found.error < 0.1
    assert found.pixels == 500_000 // found.samples
    # Where a look may take fewer paths than 20 pixels need, nothing is held against anything.
    blind = recommend(results(settings, truth), 0.1, FULL, Looks(truth, sigma, most=10_000))
    assert blind.samples and blind.error is None and blind.pixels == 0


def test_switches_say_what_they_change(truth: np.ndarray, tmp_path: Path) -> None:
    settings = [
        measured(field(0.01), 2, 0.84 * truth),
        measured(path(FULL, 4), 9, 1.3 * truth, error=0.8 * truth),
    ]
    found = results(settings, truth)
    needs = find_needs(found, Looks(truth, 1.6, most=10**6))
    lit = needs.changes[-1]
    assert lit.switch.richer == FULL and lit.bias == pytest.approx(-0.15)
    assert lit.beyond(0.02) == 1 and lit.beyond(0.2) == 0 and lit.p95 == pytest.approx(0.15)
    assert needs.changes[0].bias == 0
    shot = Shot(Scene("a<b", Path("x")), "street", SIZE)
    text = as_html(needs, shot)
    assert "lit surfaces (-15 %)" in text and "a<b" not in text
    assert "At 10 %</b> this scene needs lit surfaces (100 %)" in text
    assert "It does without all windows instead of the paper&#x27;s lists (0 %" in text
    assert "it holds: " in text and "Not rendered." in text
    # Nothing charted holds single scattering to 0.5 %: gauss is named, as not judged here.
    assert "--model single --method gauss --tolerance 0.005" in text and "neither timed" in text
    write_recommendations({shot: needs}, tmp_path / "recommendations.csv")
    with (tmp_path / "recommendations.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    asked = [f"{row['against']} {row['tolerance']}" for row in rows]
    assert asked == [f"{model} {tol}" for model in ("full", "single") for tol in (0.1, 0.02, 0.005)]
    assert [row["verdict"] for row in rows] == [
        "holds",
        *["not rendered"] * 2,
        "holds",
        "holds",
        "not rendered",
    ]
    assert rows[4]["setting"] == "field 0.01" and float(rows[4]["error"]) == pytest.approx(
        1 / 85, 1e-3
    )


def test_a_switch_costs_what_the_same_setting_takes_with_and_without_it(truth: np.ndarray) -> None:
    single = 0.85 * truth
    settings = [
        # Cheaper than any without the switch, and exact: no like of it was charted without.
        measured(field(0.1), 1, single, bake_ms=500),
        measured(gauss(UNOCCLUDED, 0.1), 10, single),
        measured(gauss(ISOTROPIC, 0.1), 40, single),
        measured(gauss(LAMBERTIAN, 0.1), 20, single),
        measured(gauss(SINGLE, 0.01), 4, single),
        measured(field(0.03, model=ISOTROPIC), 5, single, bake_ms=100),
        measured(field(0.03, model=LAMBERTIAN), 6, 3 * single, bake_ms=150),
    ]
    found = results(settings, truth)
    needs = find_needs(found, Looks(truth, 0, 0))
    costs = {change.switch.richer.name: change.cost for change in needs.changes}
    visibility, lambertian = costs["isotropic windows"], costs["Lambertian windows"]
    assert visibility and visibility.setting == "gauss --tolerance 0.1" and visibility.bake is None
    assert visibility.frame.median == pytest.approx(4)
    # The cheaper of the two settings that both were charted with, as far off as it may be.
    assert lambertian and lambertian.setting == "field --tolerance 0.03"
    assert lambertian.frame.median == pytest.approx(1.2)
    assert lambertian.bake and lambertian.bake.highest == pytest.approx(1.5)
    assert costs["single"] is None and costs["full"] is None
    text = as_html(needs, found.shot)
    assert "frame x 4.00 (4.00 to 4.00): gauss --tolerance 0.1" in text
    assert "frame x 1.20 (1.20 to 1.20), bake x 1.50 (1.50 to 1.50): field" in text
    assert text.count("no setting was timed with both") == 4


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


def test_auto_needs_no_paths_for_the_full_model(nightcity: Command, tmp_path: Path) -> None:
    stage, image = tmp_path / "thick.usda", tmp_path / "auto.exr"
    nightcity("generate", "--preset", "paper-1x1", "--extinction", 0.05, "-o", stage)
    render = ("render", stage, "--camera", CAMERA, "--size", "48x27", "--model", "auto")
    done = nightcity(*render, "--tolerance", "0.1", "--aovs", "glow", "-o", image)
    assert "by field at 0.1" in done.stderr
    file = OpenImageIO.ImageInput.open(str(image))
    spec = file.spec()
    file.close()
    assert spec.getattribute("nightcity:scattering") == "multiple"


def test_auto_refuses_what_it_decides(nightcity: Command, tmp_path: Path) -> None:
    render = ("render", small_stage(tmp_path), "--model", "auto", "-o", tmp_path / "a.exr")
    assert "--tolerance" in nightcity(*render, code=2).stderr
    more = ("--tolerance", "0.1", "--method", "march")
    assert "--method: --model auto chooses it" in nightcity(*render, *more, code=2).stderr
    assert "0.0001 to 1" in nightcity(*render, "--tolerance", "7", code=2).stderr
