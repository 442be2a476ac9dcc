# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""One setting of the renderer: how long its frame takes, and what it says of given pixels."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nightcity.errors import SceneError
from nightcity.render import run_renderer


@dataclass(frozen=True)
class Setting:
    """A point of the chart: its name and the renderer options that make it."""

    name: str
    options: tuple[str, ...]


@dataclass(frozen=True)
class Timing:
    """What one call of the renderer measured, in milliseconds and bytes."""

    device: str
    first_frame_ms: float
    steady_frame_ms: float
    bake_ms: float
    memory_bytes: int
    light_evaluations: int
    passes: dict[str, float]


def time_frames(
    scene: Path, view: list[str], setting: Setting, repeats: int, folder: Path
) -> Timing:
    """Render ``repeats`` frames, the camera moving on, and read the renderer's statistics."""
    statistics_file = folder / "statistics.json"
    run_renderer(
        [scene, *view, *setting.options, "--repeat", str(repeats), "--quiet"]
        + ["-o", folder / "timed.exr", "--stats", statistics_file]
    )
    statistics = json.loads(statistics_file.read_text())
    timing = statistics["timing"]
    return Timing(
        device=statistics["device"],
        first_frame_ms=timing["first_frame_ms"],
        steady_frame_ms=timing["steady_frame_ms"],
        bake_ms=timing["bake_ms"],
        memory_bytes=statistics["memory"]["device_bytes"],
        light_evaluations=statistics["counts"]["light_evaluations"],
        passes=timing["passes"],
    )


@dataclass(frozen=True)
class PixelTable:
    """Pixels (N, 2), their glow (N, 3), W m^-2 sr^-1; of Monte Carlo the standard error of the
    glow (N, 3), of a method that keeps a ledger its estimate of the relative error (N,), where it
    was asked for."""

    pixels: NDArray[np.int64]
    glow: NDArray[np.float64]
    glow_error: NDArray[np.float64] | None
    estimate: NDArray[np.float64] | None = None

    @staticmethod
    def joined(tables: Sequence[PixelTable]) -> PixelTable:
        """One after the other; all of the same method, at least one."""
        errors = [table.glow_error for table in tables if table.glow_error is not None]
        estimates = [table.estimate for table in tables if table.estimate is not None]
        return PixelTable(
            np.concatenate([table.pixels for table in tables]),
            np.concatenate([table.glow for table in tables]),
            np.concatenate(errors) if errors else None,
            np.concatenate(estimates) if estimates else None,
        )


def read_pixels(table: Path) -> PixelTable:
    """A table that nightcity-render wrote for --pixels, with its glow."""
    with table.open(newline="") as lines:
        rows = list(csv.DictReader(lines))
    if not rows:
        raise SceneError(f"{table}: holds no pixel")

    def channels(name: str) -> NDArray[np.float64]:
        return np.array([[float(row[f"{name}.{c}"]) for c in "RGB"] for row in rows])

    return PixelTable(
        np.array([[int(row["x"]), int(row["y"])] for row in rows]),
        channels("glow"),
        channels("glowError") if "glowError.R" in rows[0] else None,
        np.array([float(row["error.Y"]) for row in rows]) if "error.Y" in rows[0] else None,
    )


def write_pixels(pixels: NDArray[np.int64], path: Path) -> Path:
    """Write a file of ``x,y`` lines that nightcity-render reads."""
    path.write_text("x,y\n" + "".join(f"{x},{y}\n" for x, y in pixels))
    return path
