# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Calls of the renderer whose results stay in a folder, so that a killed chart goes on.

A result's name is a hash of the renderer (its version and its program), the scene, the view and
every option. A changed renderer or scene finds nothing of the old one.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import xxhash
from numpy.typing import NDArray

from nightcity.chart.runs import PixelTable, Setting, Timing, read_pixels, time_frames, write_pixels
from nightcity.chart.shot import Shot, Size
from nightcity.render import renderer, run_renderer
from nightcity.whole_file import whole_file

_CHUNK = 100  # pixels of one call: what a killed chart loses at most


@dataclass(frozen=True)
class Frame:
    """A timed call: its times, and the image of its first frame, where that was asked for."""

    timing: Timing
    image: Path | None


class Kept:
    """Results in ``folder``; what is there is read, what is not is rendered."""

    def __init__(self, folder: Path, work: Path) -> None:
        self._folder, self._work = folder, work
        folder.mkdir(parents=True, exist_ok=True)

    @cached_property
    def renderer_hash(self) -> str:
        """Of the renderer's program: its version alone does not change with every change of it."""
        return xxhash.xxh3_128_hexdigest(Path(renderer()).read_bytes())

    def frame(self, shot: Shot, setting: Setting, frames: int, part: int, image: bool) -> Frame:
        """Call number ``part`` of so many ``frames``, timed; the image only where it is asked."""
        key = [*setting.options, str(shot.size), str(frames), str(part)]
        result = self._file("frame", shot, key, ".json")
        picture = self._file("frame", shot, key, ".exr") if image else None
        if not result.is_file() or (picture and not picture.is_file()):
            timing = time_frames(shot.scene.folder, shot.view(), setting, frames, self._work)
            if picture:
                with whole_file(picture) as pending:
                    shutil.copyfile(self._work / "timed.exr", pending)
            with whole_file(result) as pending:
                pending.write_text(json.dumps(asdict(timing)))
        return Frame(Timing(**json.loads(result.read_text())), picture)

    def image(self, shot: Shot, size: Size, options: Sequence[str]) -> Path:
        """A whole image of the shot, at a size of its own, with beauty and glow."""
        file = self._file("image", shot, [*options, str(size)], ".exr")
        if not file.is_file():
            run_renderer(
                [shot.scene.folder, *shot.view(size), *options, "--aovs", "beauty,glow"]
                + ["--quiet", "-o", file]
            )
        return file

    def pixels(self, shot: Shot, pixels: NDArray[np.int64], options: Sequence[str]) -> PixelTable:
        """The values of the (N, 2) pixels, in chunks; N at least 1."""
        tables = []
        for first in range(0, len(pixels), _CHUNK):
            chunk = pixels[first : first + _CHUNK]
            key = [*options, str(shot.size), str(chunk.tolist())]
            file = self._file("pixels", shot, key, ".csv")
            if not file.is_file():
                chosen = write_pixels(chunk, self._work / "chosen.csv")
                run_renderer(
                    [shot.scene.folder, *shot.view(), *options]
                    + ["--pixels", chosen, "--quiet", "-o", file]
                )
            tables.append(read_pixels(file))
        return PixelTable.joined(tables)

    def choose_pixels(self, shot: Shot, count: int) -> NDArray[np.int64]:
        """(N, 2) random pixels that see a medium, the same every time; N at most ``count``."""
        # One step a segment: the cheapest call that chooses pixels.
        options = ["--model", "paper", "--method", "reference", "--subdivisions", "1"]
        file = self._file("chosen", shot, [*options, str(shot.size), str(count)], ".csv")
        if not file.is_file():
            run_renderer(
                [shot.scene.folder, *shot.view(), *options]
                + ["--pixels", str(count), "--quiet", "-o", file]
            )
        return read_pixels(file).pixels

    def _file(self, kind: str, shot: Shot, more: Sequence[str], ending: str) -> Path:
        key = "\n".join([self.renderer_hash, shot.scene.hash, shot.camera, *more])
        code = xxhash.xxh3_64_hexdigest(key.encode())
        return self._folder / f"{kind}.{shot.scene.name}.{shot.camera}.{code}{ending}"
