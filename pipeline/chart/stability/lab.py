# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Renders tiny scenes: one call of the renderer for all frames and pixels of a shot."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.runs import write_pixels
from nightcity.chart.stability.methods import JUDGE, PLAIN, Method, Model
from nightcity.chart.stability.tiny_scene import CAMERA, TinyScene
from nightcity.errors import NightcityError
from nightcity.export.export_stage import export_stage
from nightcity.render import run_renderer

FloatArray = NDArray[np.float64]

_GLOW, _NOISE = "glow.G", "glowError.G"


@dataclass(frozen=True)
class Glow:
    """Green glow and its standard error, W m^-2 sr^-1, both (frames, pixels)."""

    value: FloatArray
    noise: FloatArray

    def by_point(self, points: int) -> Glow:
        """(points, frames of the point x pixels)."""
        return Glow(self.value.reshape(points, -1), self.noise.reshape(points, -1))

    def noisier_by(self, other: Glow) -> Glow:
        """The same values with the noise of both: for a difference to the other."""
        return Glow(self.value, np.hypot(self.noise, other.noise))


@dataclass(frozen=True)
class Shot:
    """A scene, all frames of its camera, and the pixels wanted (default: the centre's ray)."""

    scene: TinyScene
    model: Model = PLAIN
    size: tuple[int, int] = (1, 1)
    pixels: tuple[tuple[int, int], ...] = ((0, 0),)
    judged: float = 1e-5  # tolerance of the judge, who is exact to a tenth of it


class Lab:
    """A folder for scenes and tables; a scene is written once, the judge asked once."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._scenes: dict[int, tuple[TinyScene, Path]] = {}
        self._judged: dict[int, tuple[Shot, Glow]] = {}
        self._shots: dict[tuple, Shot] = {}
        self._stages: dict[str, Path] = {}

    def shot(self, make: Callable[[FloatArray], Shot], points: FloatArray) -> Shot:
        """``make(points)``, made once for all methods."""
        key = (make, tuple(points))
        if key not in self._shots:
            self._shots[key] = make(points)
        return self._shots[key]

    def render(
        self,
        shot: Shot,
        method: Method,
        frames: Sequence[int] | None = None,
        options: Sequence[str] = (),
    ) -> Glow:
        """The glow that the method finds; ``frames`` count from 1 (default: all)."""
        scene = self._written(shot.scene)
        wanted = list(frames or range(1, shot.scene.frames + 1))
        arguments = [*method.arguments(shot.model), *options]
        if shot.size == (1, 1) and method.on_device:
            arguments += ["--primary", "rays"]  # a raster has no field of view as narrow as a ray
        copies = method.replicas if shot.size == (1, 1) else 1
        if copies == 1:
            return self._run(scene, shot.size, shot.pixels, wanted, arguments)
        row = [(x, 0) for x in range(copies)]
        glow = self._run(scene, (copies, 1), row, wanted, arguments)
        noise = np.sqrt((glow.noise**2).sum(axis=1, keepdims=True)) / copies
        return Glow(glow.value.mean(axis=1, keepdims=True), noise)

    def render_stage(self, stage: str, method: Method, model: Model, side: int) -> Glow:
        """All pixels of side x side that the first frame of a stage, a text of USD, shows."""
        if stage not in self._stages:
            path = self._folder / f"{len(self._stages)}.usda"
            path.write_text(stage)
            self._stages[stage] = path.with_suffix(".exported")
            export_stage(path, self._stages[stage])
        pixels = [(x, y) for y in range(side) for x in range(side)]
        scene, arguments = self._stages[stage], method.arguments(model)
        return self._run(scene, (side, side), pixels, [1], arguments)

    def _run(
        self,
        scene: Path,
        size: tuple[int, int],
        pixels: Sequence[tuple[int, int]],
        frames: Sequence[int],
        arguments: Sequence[str],
    ) -> Glow:
        listed = write_pixels(np.array(pixels), self._folder / "pixels.csv")
        table = self._folder / "glow.####.csv"
        run_renderer(
            [scene, "--camera", CAMERA, "--size", "x".join(map(str, size)), "--quiet"]
            + ["--pixels", listed, "--frames", ",".join(map(str, frames)), "-o", table]
            + [*arguments]
        )
        tables = [_read(self._folder / f"glow.{frame:04d}.csv") for frame in frames]
        return Glow(*(np.stack(column) for column in zip(*tables, strict=True)))

    def judge(self, shot: Shot) -> Glow:
        """What the judge says of the shot."""
        if id(shot) not in self._judged:
            judge = JUDGE.with_option("--tolerance", shot.judged)
            self._judged[id(shot)] = shot, self.render(shot, judge)
        return self._judged[id(shot)][1]

    def refusal(self, shot: Shot, method: Method) -> str | None:
        """The error with which the renderer refuses the scene; none where it renders it."""
        try:
            self.render(shot, method)
        except NightcityError as error:
            return f"exit code {error.exit_code}: {error}"
        return None

    def _written(self, scene: TinyScene) -> Path:
        if id(scene) not in self._scenes:
            folder = scene.write(self._folder / f"{len(self._scenes)}.scene")
            self._scenes[id(scene)] = scene, folder  # held, so that the id stays its own
        return self._scenes[id(scene)][1]


def _read(path: Path) -> tuple[FloatArray, FloatArray]:
    table = np.genfromtxt(path, delimiter=",", names=True, deletechars="", ndmin=1)
    value = table[_GLOW]
    noise = table[_NOISE] if _NOISE in table.dtype.names else np.zeros_like(value)
    return value, noise
