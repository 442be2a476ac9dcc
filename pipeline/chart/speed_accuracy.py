# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity chart SCENE...``: speed against accuracy, as a table, pictures and a page."""

from __future__ import annotations

import contextlib
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from nightcity.chart.growth import SETTINGS, growth_shots, measure_growth, series, smaller_cities
from nightcity.chart.kept import Kept
from nightcity.chart.look import Look
from nightcity.chart.measure import FULL, QUICK, Extent, ShotResults, measure_shot, planned_work
from nightcity.chart.needs import Needs, find_needs
from nightcity.chart.needs_text import as_html
from nightcity.chart.page import write_page
from nightcity.chart.plot import plot_speed_accuracy
from nightcity.chart.recommendations import write_recommendations
from nightcity.chart.results import Row, make_rows, write_rows
from nightcity.chart.settings import FULL_POINTS, QUICK_POINTS, Point
from nightcity.chart.shot import Scene, Shot, Size
from nightcity.errors import UsageError
from nightcity.progress import Progress
from nightcity.render import flat_scene


@dataclass(frozen=True)
class ChartOptions:
    """What is charted. cameras, size: none for the default."""

    cameras: Sequence[str] | None
    size: str | None
    quick: bool

    @property
    def extent(self) -> Extent:
        """How much work it is."""
        extent = QUICK if self.quick else FULL
        return replace(extent, size=self.size) if self.size else extent

    @property
    def points(self) -> Sequence[Point]:
        """The settings tried."""
        return QUICK_POINTS if self.quick else FULL_POINTS


def chart(stages: Sequence[Path], output: Path, options: ChartOptions) -> list[Path]:
    """Measure, and write results.csv, recommendations.csv, pictures and index.html.

    Returns their paths.

    What was measured stays in ``output``/measured: a chart that was killed goes on from there.
    """
    size = Size.parse(options.extent.size)
    output.mkdir(parents=True, exist_ok=True)
    with contextlib.ExitStack() as stack:
        work = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        kept = Kept(output / "measured", work)
        shots = [
            Shot(scene, camera, size)
            for scene in _scenes(stages, stack)
            for camera in scene.choose_cameras(options.cameras)
        ]
        results = list(_measure(kept, shots, options))
        needs = _needs(kept, results, options.extent)
        growth = {} if options.quick else _growth(kept, shots[0], work)
    rows = [row for each in results for row in make_rows(each, kept.renderer_hash)]
    return _write(rows, results, needs, growth, output)


def _scenes(stages: Sequence[Path], stack: contextlib.ExitStack) -> list[Scene]:
    scenes = []
    for stage in stages:
        name = stage.name.removesuffix(".scene").split(".usd")[0]
        if name in (scene.name for scene in scenes):
            raise UsageError(f"{stage}: a second scene of the name {name}; rename one")
        scenes.append(Scene(name, stack.enter_context(flat_scene(stage))))
    return scenes


def _measure(kept: Kept, shots: Sequence[Shot], options: ChartOptions) -> Iterator[ShotResults]:
    points, extent = options.points, options.extent
    with Progress("charting", planned_work(points, extent, len(shots))) as progress:
        for shot in shots:
            results = measure_shot(kept, shot, points, extent, progress.advance)
            for measured in results.settings:
                if measured.failure:
                    print(f"{shot}: {measured.point.name}: {measured.failure}", file=sys.stderr)
            yield results


def _needs(kept: Kept, results: Sequence[ShotResults], extent: Extent) -> dict[Shot, Needs]:
    needs = {}
    with Progress("looking at what was chosen", len(results)) as progress:
        for each in results:
            look = Look(kept, each.shot, extent.effort, extent.look_paths)
            needs[each.shot] = find_needs(each, look)
            progress.advance()
    return needs


def _growth(kept: Kept, shot: Shot, work: Path) -> dict[str, Any]:
    shots = growth_shots(shot, smaller_cities(work))
    samples = []
    with Progress("charting growth", len(shots) * len(SETTINGS)) as progress:
        for sample in measure_growth(kept, shots):
            samples.append(sample)
            progress.advance()
    return series(samples, shot)


def _write(
    rows: list[Row],
    results: list[ShotResults],
    needs: dict[Shot, Needs],
    growth: dict[str, Any],
    output: Path,
) -> list[Path]:
    table, recommended = output / "results.csv", output / "recommendations.csv"
    write_rows(rows, table)
    write_recommendations(needs, recommended)
    pictures = [
        path
        for each in results
        for path in plot_speed_accuracy(
            rows, each.shot, output / f"{each.shot.scene.name}.{each.shot.camera}"
        )
    ]
    page = output / "index.html"
    words = {str(shot): as_html(found, shot) for shot, found in needs.items()}
    write_page(rows, results, words, growth, page)
    return [table, recommended, *pictures, page]
