# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The images of a job, as its step Check names them."""

from __future__ import annotations

from pathlib import Path

from nightcity.farm.job import FarmStep
from nightcity.frames import frame_file, parse_frames

# Exit codes of the check that did its work: all are there, some are missing.
CHECKED = frozenset({0, 1})


def images(check: FarmStep) -> dict[int, Path]:
    """The file of each frame."""
    command = check.tasks[0].command
    pattern = Path(command[command.index("-o") + 1])
    frames = parse_frames(command[command.index("--frames") + 1])
    return {frame: frame_file(pattern, frame) for frame in frames}


def name_unchecked(check: FarmStep) -> None:
    """Print a line for each image where there is no scene to check them by."""
    for image in images(check).values():
        print(f"{'unchecked' if image.exists() else 'missing'} {image}", flush=True)
