# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench mitsuba``: an independent renderer against the judge, on the same rays.

Mitsuba 3 gets our scene as it is exported: lit windows as one-sided rectangles, walls that
reflect nothing, one box of haze that the buildings stand in. Its error bar comes from the spread
of independent passes. It is optimistic where few paths carry much light: distance sampling near
a small window has a heavy tail.
"""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nightcity.bench.judge import Keeper, View, choose_pixels
from nightcity.bench.ladder import table_head
from nightcity.bench.mitsuba_environment import MitsubaEnvironment
from nightcity.bench.peer_scene import write_peer_scene
from nightcity.bench.scenes import open_scene
from nightcity.chart.agreement import MEAN_SIGMAS
from nightcity.errors import UsageError

_PROGRAM = Path(__file__).with_name("mitsuba_program.py")
_JUDGE = ("--lights", "all", "--visibility", "full", "--emitter", "pane", "--method", "reference")
_JUDGE_TOLERANCE = "0.01"  # the judge converges to a tenth of it
_GREEN = 1  # peer_scene.py renders this channel
_FEWEST_PASSES = 16  # with fewer the spread itself is guesswork


@dataclass(frozen=True)
class PeerOptions:
    """passes: independent estimates of the image, each of ``samples`` paths a pixel."""

    cameras: list[str] | None
    size: str
    pixels: int
    samples: int
    passes: int
    kept: Path | None
    environment: Path
    install: bool

    def __post_init__(self) -> None:
        if self.pixels < 1 or self.samples < 1:
            raise UsageError("--pixels and --samples: give at least 1")
        if self.passes < _FEWEST_PASSES:
            raise UsageError(f"--passes: an error bar needs at least {_FEWEST_PASSES}")


@dataclass(frozen=True)
class PeerResult:
    """ratio of the means, 1 in truth, and its standard error."""

    ratio: float
    error: float

    @property
    def agrees(self) -> bool:
        return abs(self.ratio - 1) <= MEAN_SIGMAS * self.error


def compare_passes(passes: NDArray[np.float64], truth: NDArray[np.float64]) -> PeerResult:
    """(P, N) independent estimates of N pixels against their truth (N,); P at least 2."""
    ratios = passes.mean(axis=1) / truth.mean()
    return PeerResult(float(ratios.mean()), float(ratios.std(ddof=1) / np.sqrt(len(ratios))))


def bench_mitsuba(source: str, options: PeerOptions) -> int:
    """Print a row for each camera; returns 1 where the two renderers disagree, else 0."""
    environment = MitsubaEnvironment(options.environment)
    if options.install:
        environment.install()
    environment.require()
    disagreements = 0
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        keeper = Keeper(options.kept or work / "kept")
        scene = open_scene(source, work)
        cameras = scene.choose_cameras(options.cameras)
        heads = ["scene", "camera", "rays", "paths a ray", "Mitsuba / judge", "standard error"]
        print(table_head(*heads, "verdict"), flush=True)
        for camera in cameras:
            view = View(scene, camera, options.size)
            pixels = choose_pixels(view, options.pixels, work)
            write_peer_scene(view, pixels, work / "scene.npz")
            counts = [str(options.samples), str(options.passes)]
            environment.run(_PROGRAM, [work / "scene.npz", work / "result.npy", *counts])
            judge = (*_JUDGE, "--tolerance", _JUDGE_TOLERANCE)
            truth = keeper.measure(view, pixels, judge, work).glow[:, _GREEN]
            result = compare_passes(np.load(work / "result.npy"), truth)
            disagreements += not result.agrees
            sigmas = abs(result.ratio - 1) / result.error
            verdict = "agrees" if result.agrees else "DISAGREES"
            print(
                f"| {scene.name} | {camera} | {len(pixels)} | {options.samples * options.passes} "
                f"| {result.ratio:.4f} | {result.error:.4f} "
                f"| {verdict}: {sigmas:.1f} standard errors |",
                flush=True,
            )
    return 1 if disagreements else 0
