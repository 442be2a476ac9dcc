# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench cycles``: how long Cycles and ``field`` take to the same error of an image.

Both render single scattering with panes and full visibility, held against the judge's means over
64 places of a pixel. Cycles (light tree, equiangular sampling) renders passes until the median
error is reached, and counts from the scene's begin, without the start of Blender; where its time
is up before, the time is foretold from error ~ 1 / sqrt(samples), and said to be. ``field`` counts
from the start of its process to its end: load, bake, first frame, written file.
"""

from __future__ import annotations

import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nightcity.bench.judge import Keeper, View, choose_pixels, say
from nightcity.bench.ladder import table_head
from nightcity.bench.peer_environment import PeerEnvironment
from nightcity.bench.peer_scene import write_peer_scene
from nightcity.bench.scenes import open_scene
from nightcity.chart.errors import FLOOR_SHARE, ErrorStatistics, error_statistics
from nightcity.chart.frame_file import FrameFile
from nightcity.chart.truth import INTEGRATED_PLACES
from nightcity.errors import UsageError
from nightcity.render import run_renderer

_PROGRAM = Path(__file__).with_name("cycles_program.py")
_REQUIREMENTS = ("bpy==5.0.1",)  # the last for Python 3.11
_MODEL = ("--model", "single")
_GREEN = 1  # peer_scene.py's channel
_TOLERANCES = ("0.1", "0.03", "0.01")
_PIXEL_SAMPLES = ("1", "4", "16")


@dataclass(frozen=True)
class EqualErrorOptions:
    """error: the median to reach, a share. samples: a pixel and pass of Cycles. limit: its
    seconds."""

    camera: str
    size: str
    pixels: int
    error: float
    samples: int
    limit: float
    kept: Path | None
    environment: Path
    install: bool

    def __post_init__(self) -> None:
        if self.pixels < 1 or self.samples < 1:
            raise UsageError("--pixels and --samples: give at least 1")
        if not (self.error > 0 and self.limit > 0):
            raise UsageError("--error and --limit: must be above 0")


@dataclass(frozen=True)
class Run:
    """One renderer's image: seconds, and its errors at the pixels; foretold: what it would take
    to the error asked for."""

    name: str
    seconds: float
    errors: ErrorStatistics
    foretold: float | None = None


def bench_cycles(source: str, options: EqualErrorOptions) -> None:
    """Print both renderers' rows, and the ratio of their times."""
    environment = PeerEnvironment(options.environment, "Blender's bpy", _REQUIREMENTS)
    if options.install:
        environment.install()
    environment.require()
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        scene = open_scene(source, work)
        view = View(scene, *scene.choose_cameras([options.camera]), options.size)
        pixels = choose_pixels(view, options.pixels, work)
        keeper = Keeper(options.kept or work / "kept")
        judge = (*_MODEL, "--method", "reference", "--tolerance", "0.01")
        places = ("--pixel-samples", str(INTEGRATED_PLACES))
        truth = keeper.measure(view, pixels, (*judge, *places), work).glow[:, _GREEN]
        print(table_head("renderer", "seconds", "median error", "p95", "bias"))
        ours = _field_runs(view, pixels, truth, work)
        peer = _cycles_run(view, pixels, truth, options, environment, work)
        for run in (*ours, peer):
            print(_row(run), flush=True)
        _print_ratio(ours, peer, options.error)


def _field_runs(
    view: View, pixels: NDArray[np.int64], truth: NDArray[np.float64], work: Path
) -> list[Run]:
    runs = []
    for tolerance in _TOLERANCES:
        for samples in _PIXEL_SAMPLES:
            image = work / "field.exr"
            field = (*_MODEL, "--method", "field", "--tolerance", tolerance)
            started = time.monotonic()
            run_renderer(
                [view.scene.folder, *view.options, *field, "--pixel-samples", samples]
                + ["--filter", "box", "--aovs", "beauty,glow", "--quiet", "-o", image]
            )
            seconds = time.monotonic() - started
            glow = FrameFile.read(image).at(pixels)[0][:, _GREEN]
            name = f"field {tolerance}, {samples} rays a pixel"
            runs.append(Run(name, seconds, _errors(glow, truth)))
            say(f"{name}: {seconds:.1f} s")
    return runs


def _cycles_run(
    view: View,
    pixels: NDArray[np.int64],
    truth: NDArray[np.float64],
    options: EqualErrorOptions,
    environment: PeerEnvironment,
    work: Path,
) -> Run:
    write_peer_scene(view, pixels, work / "scene.npz")
    floor = FLOOR_SHARE * np.median(truth[truth > 0])
    np.savez(work / "asked.npz", **np.load(work / "scene.npz"), truth=truth, floor=floor)
    numbers = [str(options.samples), f"{options.error:g}", f"{options.limit:g}"]
    environment.run(_PROGRAM, [work / "asked.npz", work / "cycles.npz", *numbers])
    found = np.load(work / "cycles.npz")
    errors = _errors(found["means"].mean(axis=0), truth)
    seconds = float(found["seconds"][-1])
    reached = errors.median <= options.error
    foretold = None if reached else seconds * (errors.median / options.error) ** 2
    samples = options.samples * len(found["means"])
    return Run(f"Cycles, {samples} samples a pixel", seconds, errors, foretold)


def _errors(values: NDArray[np.float64], truth: NDArray[np.float64]) -> ErrorStatistics:
    return error_statistics(*(np.repeat(one[:, None], 3, axis=1) for one in (values, truth)))


def _row(run: Run) -> str:
    errors = run.errors
    return (
        f"| {run.name} | {run.seconds:.1f} | {100 * errors.median:.2g} % "
        f"| {100 * errors.p95:.2g} % | {100 * errors.bias:+.2g} % |"
    )


def _print_ratio(ours: list[Run], peer: Run, error: float) -> None:
    able = [run for run in ours if run.errors.median <= error]
    if not able:
        print(f"\nno setting of field reached {100 * error:g} % median")
        return
    best = min(able, key=lambda run: run.seconds)
    seconds = peer.foretold or peer.seconds
    how = "foretold as 1 / error^2" if peer.foretold else "rendered"
    print(
        f"\nto {100 * error:g} % median: Cycles {seconds:.0f} s ({how}), {best.name} "
        f"{best.seconds:.1f} s: {seconds / best.seconds:.0f} times"
    )
