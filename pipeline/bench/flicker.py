# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""``nightcity bench flicker``: how steady a method's error is from frame to frame of a shot.

A patch of 4 x 4 pixels is rendered in every frame and held against the judge. An error that stays
is not seen in a movie; what flickers is its change. The same pixels move over the scene with the
camera, and windows go on and off: the judge does all that too, so that the change of the relative
error is the method's own.
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nightcity.bench.judge import View, choose_pixels, say
from nightcity.bench.ladder import table_head
from nightcity.bench.scenes import open_scene
from nightcity.chart.errors import FLOOR_SHARE, LUMINANCE
from nightcity.chart.runs import read_pixels, write_pixels
from nightcity.errors import SceneError, UsageError
from nightcity.render import run_renderer

_PATCH = 4  # pixels along a side
_CANDIDATES = 16  # patches, of which the one that sees lit haze most often is taken
# A city whose windows go on and off in the evening while the camera flies over it.
NIGHT = {"grid": (30, 30), "frames": 24, "time": "18:00-02:00"}
NIGHT_PRESET = "city-100x100"
METHODS = ("march", "gauss", "field", "path")


@dataclass(frozen=True)
class FlickerOptions:
    """camera, size: of the shot. frames: first and last. emitter: of all methods."""

    methods: Sequence[str]
    tolerance: float
    emitter: str
    camera: str
    size: str
    frames: tuple[int, int]

    def __post_init__(self) -> None:
        if self.frames[1] <= self.frames[0]:
            raise UsageError("--frames: a change from frame to frame wants at least two")

    @property
    def model(self) -> tuple[str, ...]:
        return ("--lights", "all", "--visibility", "full", "--emitter", self.emitter)


@dataclass(frozen=True)
class Flicker:
    """Shares: the median error of a pixel and frame; its change from frame to frame, root mean
    square and largest; the largest change of the error of the patch's mean."""

    median: float
    rms_change: float
    largest_change: float
    mean_change: float


def flicker_of(glow: NDArray[np.float64], truth: NDArray[np.float64]) -> Flicker:
    """Of (F, N) glow, frame by frame; F at least 2. Pixels and patches that are dark in truth count
    against 1 % of the median of pixels that are not."""
    floor = FLOOR_SHARE * float(np.median(truth[truth > 0]))
    errors = (glow - truth) / np.maximum(truth, floor)
    change = np.diff(errors, axis=0)
    mean = (glow - truth).mean(axis=1) / np.maximum(truth.mean(axis=1), floor)
    return Flicker(
        float(np.median(np.abs(errors))),
        float(np.sqrt(np.mean(change**2))),
        float(np.abs(change).max()),
        float(np.abs(np.diff(mean)).max()),
    )


def flicker(source: str | None, options: FlickerOptions) -> None:
    """Print a row for each method."""
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        scene = open_scene(source or NIGHT_PRESET, work, None if source else NIGHT)
        view = View(scene, *scene.choose_cameras([options.camera]), options.size)
        patch = write_pixels(_patch(view, options, work), work / "patch.csv")
        judge = [*options.model, "--method", "reference", "--tolerance", "0.01"]
        truth = _render(view, options, judge, patch, work)
        if not np.any(truth > 0):
            raise SceneError(f"{view}: no pixel of the patch sees lit haze")
        say(f"{view}: {np.count_nonzero(truth)} of {truth.size} pixels and frames see lit haze")
        print(table_head("method", "median error", "change, rms", "largest", "of the patch's mean"))
        for method in options.methods:
            say(f"{view}: {method}")
            found = flicker_of(_render(view, options, _model(options, method), patch, work), truth)
            values = (found.median, found.rms_change, found.largest_change, found.mean_change)
            print(
                f"| {method} | " + " | ".join(f"{100 * x:.2g} %" for x in values) + " |", flush=True
            )


def _model(options: FlickerOptions, method: str) -> list[str]:
    if method == "march":
        return ["--model", "paper", "--method", "march"]
    tolerance = ["--tolerance", f"{options.tolerance:g}"] if method != "path" else []
    return [*options.model, "--method", method, *tolerance]


def _patch(view: View, options: FlickerOptions, work: Path) -> NDArray[np.int64]:
    """(16, 2) pixels: of some patches that see haze in the first frame the one whose pixels see
    lit haze in most frames, by the paper's march, which is cheap."""
    width, height = (int(side) for side in view.size.split("x"))
    if min(width, height) < _PATCH:
        raise UsageError(f"--size {view.size}: a patch has {_PATCH} x {_PATCH} pixels")
    corners = choose_pixels(view, _CANDIDATES, work) - _PATCH // 2
    corners = np.clip(corners, 0, [width - _PATCH, height - _PATCH])
    x, y = np.meshgrid(np.arange(_PATCH), np.arange(_PATCH))
    patches = corners[:, None] + np.stack([x.ravel(), y.ravel()], axis=1)
    file = write_pixels(patches.reshape(-1, 2), work / "candidates.csv")
    glow = _render(view, options, _model(options, "march"), file, work)
    lit = (glow.reshape(len(glow), len(patches), -1) > 0).sum(axis=(0, 2))
    return patches[np.argmax(lit)]


def _render(
    view: View, options: FlickerOptions, asked: list[str], patch: Path, work: Path
) -> NDArray[np.float64]:
    """Luminance (F, N) of the glow of N pixels in every frame."""
    first, last = options.frames
    run_renderer(
        [view.scene.folder, *view.options, *asked, "--pixels", patch]
        + ["--frames", f"{first}-{last}", "--quiet", "-o", work / "patch.####.csv"]
    )
    tables = [read_pixels(work / f"patch.{frame:04d}.csv") for frame in range(first, last + 1)]
    return np.array([table.glow @ LUMINANCE for table in tables])
