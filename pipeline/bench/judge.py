# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Values of chosen pixels by any method, and the judge's, which are kept for the next run."""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xxhash
from numpy.typing import NDArray

from nightcity.bench.scenes import MeasuredScene
from nightcity.chart.runs import PixelTable, read_pixels, write_pixels
from nightcity.errors import SceneError
from nightcity.render import run_renderer

_CHUNK = 100  # pixels of one call: what an interrupted run loses at most
# One step a segment: the cheapest call that chooses pixels.
_CHOOSE = ("--model", "paper", "--method", "reference", "--subdivisions", "1")


@dataclass(frozen=True)
class View:
    """What is looked at: a scene through one of its cameras."""

    scene: MeasuredScene
    camera: str
    size: str

    @property
    def options(self) -> list[str]:
        return ["--camera", self.camera, "--size", self.size]

    def __str__(self) -> str:
        return f"{self.scene.name} {self.camera}"


def choose_pixels(view: View, count: int, work: Path) -> NDArray[np.int64]:
    """(N, 2) random pixels that see a medium, the same in every run; N at most ``count``."""
    return _render(view, [*_CHOOSE, "--pixels", str(count)], work).pixels


def measure(
    view: View, pixels: NDArray[np.int64], options: Sequence[str], work: Path
) -> PixelTable:
    """The values of these pixels with the renderer's ``options``."""
    chosen = write_pixels(pixels, work / "chosen.csv")
    return _render(view, [*options, "--pixels", str(chosen)], work)


def _render(view: View, options: Sequence[str], work: Path) -> PixelTable:
    table = work / "measured.csv"
    run_renderer([view.scene.folder, *view.options, *options, "--quiet", "-o", table])
    return read_pixels(table)


@dataclass(frozen=True)
class Keeper:
    """Keeps slow results in a folder.

    A table's name holds a hash of the scene, the view, the options and the pixels, and nothing
    of the renderer: where the renderer's own arithmetic has changed, start an empty folder.
    """

    folder: Path

    def measure(
        self, view: View, pixels: NDArray[np.int64], options: Sequence[str], work: Path
    ) -> PixelTable:
        """As ``measure``, in chunks, each taken from the folder where it is there."""
        self.folder.mkdir(parents=True, exist_ok=True)
        tables, started = [], time.monotonic()
        for first in range(0, len(pixels), _CHUNK):
            chunk = pixels[first : first + _CHUNK]
            file = self._file(view, chunk, options)
            if not file.is_file():
                chosen = write_pixels(chunk, work / "chosen.csv")
                run_renderer(
                    [view.scene.folder, *view.options, *options, "--pixels", chosen]
                    + ["--quiet", "-o", file]
                )
                seconds = time.monotonic() - started
                say(f"{view}: {first + len(chunk)} of {len(pixels)} pixels, {seconds:.0f} s")
            table = read_pixels(file)
            if not np.array_equal(table.pixels, chunk):
                raise SceneError(f"{file}: holds other pixels than its name says; remove it")
            tables.append(table)
        return PixelTable.joined(tables)

    def _file(self, view: View, pixels: NDArray[np.int64], options: Sequence[str]) -> Path:
        key = "\n".join([view.scene.hash, *view.options, *options, str(pixels.tolist())])
        name = f"{view.scene.name}.{view.camera}.{xxhash.xxh3_128_hexdigest(key.encode())}.csv"
        return self.folder / name


def say(text: str) -> None:
    """A line of progress."""
    print(f"nightcity bench: {text}", file=sys.stderr, flush=True)
