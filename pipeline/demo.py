# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity demo``: the main job once, as a user would do it by hand."""

from __future__ import annotations

import sys
from pathlib import Path

from nightcity.chart.speed_accuracy import chart
from nightcity.city.generate import generate
from nightcity.city.import_town import import_town
from nightcity.city.model import City
from nightcity.city.parameters import load_parameters
from nightcity.city.town_options import TownOptions
from nightcity.errors import UsageError
from nightcity.export.export_stage import export_stage
from nightcity.render import run_renderer
from nightcity.stage.write import write_stage

_TOWN = Path(__file__).resolve().parents[1] / "tests/data/delft-excerpt.city.json"
_SIZE = "1920x1061"


def demo(output: Path, town: Path | None) -> None:
    """Make a paper city and a town, render three pictures and a chart, and name the files."""
    town = town or _TOWN
    if not town.is_file():
        raise UsageError(f"{town}: no such CityJSON file; name one with --town")
    output.mkdir(parents=True, exist_ok=True)
    made: list[Path] = []
    _say("generating the paper's 4 x 4 city")
    made += _pictures(generate(load_parameters("paper-4x4")), output / "paper-4x4", made_of(4))
    _say(f"importing {town.name}")
    made += _pictures(import_town(town, TownOptions()), output / "town", made_of(1))
    _say("charting speed against accuracy")
    made += chart(output / "paper-4x4.scene", output / "chart", "overview75", quick=True)
    print("made:")
    for path in made:
        print(f"  {path}")


def made_of(samples: int) -> list[str]:
    """Renderer options of the demo's pictures: the paper's method, ``samples`` a pixel."""
    return ["--model", "paper", "--method", "march", "--pixel-samples", str(samples)]


def _pictures(city: City, stem: Path, options: list[str]) -> list[Path]:
    stage, scene = stem.with_suffix(".usda"), stem.with_suffix(".scene")
    made = write_stage(city, stage)[-1:]
    export_stage(stage, scene)
    for camera in ("overview75", "street"):
        picture = stem.with_name(f"{stem.name}.{camera}.png")
        exr = picture.with_suffix(".exr")
        _say(f"rendering {picture.name}")
        view = [scene, "--camera", camera, "--size", _SIZE, *options]
        run_renderer([*view, "-o", exr])
        run_renderer([*view, "-o", picture])
        made += [exr, picture]
    return [stage, scene, *made[1:]]


def _say(text: str) -> None:
    print(f"nightcity demo: {text}", file=sys.stderr, flush=True)
