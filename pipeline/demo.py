# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity demo``: the main job once, as a user would do it by hand."""

from __future__ import annotations

import sys
from pathlib import Path

from nightcity.chart.speed_accuracy import ChartOptions, chart
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
_TOLERANCE = "0.03"  # nobody sees less, and the bake is short


def demo(output: Path, town: Path | None) -> None:
    """Make a paper city and a town, render three pictures and a chart, and name the files."""
    town = town or _TOWN
    if not town.is_file():
        raise UsageError(f"{town}: no such CityJSON file; name one with --town")
    output.mkdir(parents=True, exist_ok=True)
    _say("generating the paper's 4 x 4 city")
    made = _pictures(generate(load_parameters("paper-4x4")), output / "paper-4x4", samples=4)
    scene = output / "paper-4x4.scene"
    _say("rendering the same as OpenEXR, with every channel")
    made.append(_render(scene, "overview75", output / "paper-4x4.overview75.exr", samples=1))
    _say(f"importing {town.name}")
    made += _pictures(import_town(town, TownOptions()), output / "town", samples=2)
    _say("charting speed against accuracy")
    made += chart([scene], output / "chart", ChartOptions(["overview75"], None, quick=True))
    print("made:")
    for path in made:
        print(f"  {path}")


def _pictures(city: City, stem: Path, samples: int) -> list[Path]:
    stage, scene = stem.with_suffix(".usda"), stem.with_suffix(".scene")
    write_stage(city, stage)
    export_stage(stage, scene)
    made = [stage, scene]
    for camera in ("overview75", "street"):
        picture = stem.with_name(f"{stem.name}.{camera}.png")
        _say(f"rendering {picture.name}")
        made.append(_render(scene, camera, picture, samples))
    return made


def _render(scene: Path, camera: str, picture: Path, samples: int) -> Path:
    run_renderer(
        [scene, "--camera", camera, "--size", _SIZE, "--tolerance", _TOLERANCE]
        + ["--pixel-samples", str(samples), "--quiet", "-o", picture]
    )
    return picture


def _say(text: str) -> None:
    print(f"nightcity demo: {text}", file=sys.stderr, flush=True)
