# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""How cost grows: a few settings in cities of the paper from 1 x 1 up to the charted scene, and in
the scene itself at growing sizes."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from nightcity.chart.kept import Kept
from nightcity.chart.settings import PAPER, SURFACE, field, gauss, march
from nightcity.chart.shot import Scene, Shot, Size
from nightcity.errors import NightcityError

SETTINGS = {
    "surface frame": (SURFACE, 3),
    **{
        point.name: (point.setting, point.frames)
        for point in (march(25), gauss(PAPER, 0.01), field(0.1))
    },
}
SMALLER = ("paper-1x1", "paper-2x2", "paper-3x3")
# Of the frame's sides, in thirds: its pixels grow by 4 from one to the next.
_SIDES = (1, 2, 4)
_COUNTS = {"windows": "window", "buildings": "building", "media boxes": "media_box"}


@dataclass(frozen=True)
class Sample:
    """One setting of one scene at one size; times in ms, counts by the names of _COUNTS."""

    setting: str
    scene: str
    size: str
    pixels: int
    counts: dict[str, int]
    steady_frame_ms: float
    bake_ms: float
    memory_bytes: int


def smaller_cities(work: Path) -> list[Scene]:
    """The paper's smaller cities as flat scenes, made by the commands that a user calls."""
    scenes = []
    for preset in SMALLER:
        stage, folder = work / f"{preset}.usda", work / f"{preset}.scene"
        _nightcity("generate", "--preset", preset, "-o", str(stage))
        _nightcity("export", str(stage), "-o", str(folder))
        scenes.append(Scene(preset, folder))
    return scenes


def _nightcity(*arguments: str) -> None:
    command = [sys.executable, "-m", "nightcity", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise NightcityError(f"nightcity {' '.join(arguments)}: {done.stderr.strip()}")


def growth_shots(shot: Shot, others: Sequence[Scene]) -> list[Shot]:
    """The shot, the same scene at other sizes, and the others seen as much alike as they can be."""
    own = [Shot(shot.scene, shot.camera, size) for size in _sizes(shot.size)]
    alike = [
        Shot(scene, camera, shot.size)
        for scene in others
        for camera in scene.choose_cameras([shot.camera] if shot.camera in scene.cameras else None)
    ]
    return [shot, *own, *alike]


def _sizes(size: Size) -> list[Size]:
    judged = size.judged
    return [Size(n * judged.width, n * judged.height) for n in _SIDES]


def measure_growth(kept: Kept, shots: Sequence[Shot]) -> Iterator[Sample]:
    """Every setting in every shot, one call each; a setting that fails there is left out."""
    for shot in shots:
        counts = {name: shot.scene.count(kind) for name, kind in _COUNTS.items()}
        for name, (setting, frames) in SETTINGS.items():
            try:
                timing = kept.frame(shot, setting, frames, 0, image=False).timing
            except NightcityError as error:
                print(f"{shot}: {name}: {error}", file=sys.stderr)
                continue
            pixels = shot.size.width * shot.size.height
            yield Sample(
                *(name, shot.scene.name, str(shot.size), pixels, counts),
                *(timing.steady_frame_ms, timing.bake_ms, timing.memory_bytes),
            )


def series(samples: Sequence[Sample], shot: Shot) -> dict[str, Any]:
    """For the page: by what grows, then by setting, the samples in their order, ``x`` what grows.

    Pixels grow within the shot's scene; everything else from scene to scene at the shot's size.
    """
    alike = [sample for sample in samples if sample.size == str(shot.size)]
    own = [sample for sample in samples if sample.scene == shot.scene.name]
    grown = {"pixels": _curves(own, lambda sample: sample.pixels)}
    for name in _COUNTS:
        grown[name] = _curves(alike, lambda sample, name=name: sample.counts[name])
    return grown


def _curves(samples: Sequence[Sample], grows: Any) -> dict[str, Any]:
    curves: dict[str, Any] = {}
    for sample in sorted(samples, key=grows):
        curve = curves.setdefault(sample.setting, [])
        entry = {**asdict(sample), "x": grows(sample)}
        if entry not in curve:
            curve.append(entry)
    return curves
