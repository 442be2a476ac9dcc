# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The first chart: the paper's march at several step counts, its time against its error.

The error is *numerical*: against the same model, marched in double precision on the CPU with far
more steps. Timings are interleaved, so that a machine that slows down slows all settings alike.
"""

from __future__ import annotations

import csv
import statistics
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

from nightcity.chart.errors import ErrorStatistics, error_statistics
from nightcity.chart.plot import plot_speed_accuracy
from nightcity.chart.runs import Setting, Timing, render_pixels, time_frames, write_pixels
from nightcity.progress import Progress
from nightcity.render import flat_scene

STEPS = (5, 25, 40, 100)
SURFACE = Setting("surface frame", ("--media", "off"))
_MARCH = ("--model", "paper", "--method", "march")
SETTINGS = tuple(
    Setting(
        f"march-{steps}, {order} outside",
        (*_MARCH, "--subdivisions", str(steps), "--march-order", order),
    )
    for order in ("steps", "lights")
    for steps in STEPS
)


@dataclass(frozen=True)
class Extent:
    """How much work a chart is: frame size, timed calls a setting, frames a call, pixels judged."""

    size: str
    rounds: int
    repeats: int
    pixels: int
    reference_steps: int


QUICK = Extent("960x530", rounds=2, repeats=3, pixels=500, reference_steps=4000)
FULL = Extent("1920x1061", rounds=3, repeats=5, pixels=2000, reference_steps=10000)


@dataclass(frozen=True)
class Row:
    """One row of results.csv."""

    setting: Setting
    timing: Timing
    spread_ms: float
    ratio_to_surface: float
    error: ErrorStatistics | None  # none for the surface frame, which has no glow


def chart(stage: Path, output: Path, camera: str | None, quick: bool) -> list[Path]:
    """Measure and draw; returns the files written (results.csv, speed-accuracy.svg, .png)."""
    extent = QUICK if quick else FULL
    view = ["--size", extent.size, *(["--camera", camera] if camera else [])]
    output.mkdir(parents=True, exist_ok=True)
    with flat_scene(stage) as scene, tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        steps = (extent.rounds + 1) * len(SETTINGS) + extent.rounds + 1
        with Progress("charting", steps) as progress:
            errors = _errors(scene, view, extent, work, progress)
            timings = _timings(scene, view, extent, work, progress)
    rows = _rows(errors, timings)
    table = output / "results.csv"
    _write_table(rows, extent, table)
    return [table, *plot_speed_accuracy(rows, output / "speed-accuracy")]


def _errors(
    scene: Path, view: list[str], extent: Extent, work: Path, progress: Progress
) -> dict[Setting, ErrorStatistics]:
    judge = Setting(
        "reference", ("--method", "reference", "--subdivisions", str(extent.reference_steps))
    )
    pixels, truth = render_pixels(scene, view, judge, str(extent.pixels), work)
    progress.advance()
    chosen = str(write_pixels(pixels, work / "chosen.csv"))
    errors = {}
    for setting in SETTINGS:
        glow = render_pixels(scene, view, setting, chosen, work)[1]
        errors[setting] = error_statistics(glow, truth)
        progress.advance()
    return errors


def _timings(
    scene: Path, view: list[str], extent: Extent, work: Path, progress: Progress
) -> dict[Setting, list[Timing]]:
    timings: dict[Setting, list[Timing]] = {setting: [] for setting in (SURFACE, *SETTINGS)}
    for _ in range(extent.rounds):
        for setting, measured in timings.items():
            measured.append(time_frames(scene, view, setting, extent.repeats, work))
            progress.advance()
    return timings


def _rows(
    errors: dict[Setting, ErrorStatistics], timings: dict[Setting, list[Timing]]
) -> list[Row]:
    def steady(setting: Setting) -> list[float]:
        return [timing.steady_frame_ms for timing in timings[setting]]

    surface = statistics.median(steady(SURFACE))
    rows = []
    for setting, measured in timings.items():
        times = steady(setting)
        middle = min(measured, key=lambda t: abs(t.steady_frame_ms - statistics.median(times)))
        ratio = statistics.median(times) / surface
        rows.append(Row(setting, middle, max(times) - min(times), ratio, errors.get(setting)))
    return rows


def _write_table(rows: list[Row], extent: Extent, path: Path) -> None:
    with path.open("w", newline="") as file:
        table = csv.writer(file)
        error_fields = list(ErrorStatistics.__dataclass_fields__)
        table.writerow(
            ["setting", "options", "size", "device", "steady_frame_ms", "spread_ms"]
            + ["ratio_to_surface", "first_frame_ms", "bake_ms", "memory_bytes"]
            + ["light_evaluations", *error_fields]
        )
        for row in rows:
            error = asdict(row.error) if row.error else {}
            table.writerow(
                [row.setting.name, " ".join(row.setting.options), extent.size, row.timing.device]
                + [f"{row.timing.steady_frame_ms:.3f}", f"{row.spread_ms:.3f}"]
                + [f"{row.ratio_to_surface:.3f}", f"{row.timing.first_frame_ms:.3f}"]
                + [f"{row.timing.bake_ms:.3f}", row.timing.memory_bytes]
                + [row.timing.light_evaluations]
                + [f"{error[name]:.6g}" if error else "" for name in error_fields]
            )
