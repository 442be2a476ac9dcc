# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What a chart looks at: a flat scene through one of its cameras, at one size."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import xxhash

from nightcity.errors import SceneError, UsageError

STRIDE = 3  # odd, so that the middle of every third pixel is a pixel's middle at a third the size


@dataclass(frozen=True)
class Size:
    """Pixels of a frame; both divide by STRIDE."""

    width: int
    height: int

    @staticmethod
    def parse(text: str) -> Size:
        """``WIDTHxHEIGHT``; UsageError says what would do."""
        match = re.fullmatch(r"(\d+)x(\d+)", text)
        if not match:
            raise UsageError(f"--size {text}: give WIDTHxHEIGHT in pixels, like 480x267")
        sides = [int(side) for side in match.groups()]
        nearest = [max(STRIDE * round(side / STRIDE), STRIDE) for side in sides]
        if sides != nearest:
            raise UsageError(
                f"--size {text}: the judge sees every third pixel of every third row: both sides "
                f"must divide by 3, like {nearest[0]}x{nearest[1]}"
            )
        return Size(*sides)

    @property
    def judged(self) -> Size:
        """Of the images that the judge makes: every third pixel of every third row."""
        return Size(self.width // STRIDE, self.height // STRIDE)

    def __str__(self) -> str:
        return f"{self.width}x{self.height}"


@dataclass(frozen=True)
class Scene:
    """A flat scene on disk and its name in the chart."""

    name: str
    folder: Path

    @cached_property
    def _manifest(self) -> bytes:
        return (self.folder / "scene.json").read_bytes()

    @cached_property
    def hash(self) -> str:
        """As docs/scene_format.md has it; covers all of the scene."""
        return xxhash.xxh3_128_hexdigest(self._manifest)

    def count(self, kind: str) -> int:
        """Records of a kind, like ``window``."""
        return int(json.loads(self._manifest)["arrays"][kind]["count"])

    @property
    def cameras(self) -> list[str]:
        """Their names."""
        return [camera["name"] for camera in json.loads(self._manifest)["cameras"]]

    def choose_cameras(self, asked: Sequence[str] | None) -> list[str]:
        """The cameras asked for, else the first; an error names those that there are."""
        there = self.cameras
        if not there:
            raise SceneError(f"{self.folder}: has no camera to chart; add one to the stage")
        missing = [name for name in asked or () if name not in there]
        if missing:
            raise UsageError(
                f"--cameras {missing[0]}: the cameras of {self.name} are {', '.join(there)}"
            )
        return list(asked) if asked else there[:1]


@dataclass(frozen=True)
class Shot:
    """A camera of a scene, and the size of its frames."""

    scene: Scene
    camera: str
    size: Size

    def view(self, size: Size | None = None) -> list[str]:
        """The renderer's options; ``size``: another than the frames'."""
        return ["--camera", self.camera, "--size", str(size or self.size)]

    def __str__(self) -> str:
        return f"{self.scene.name} {self.camera}"
