# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Frame numbers and the names of their files, as the renderer reads and writes them."""

from __future__ import annotations

import re
from pathlib import Path

from nightcity.errors import UsageError

_PART = re.compile(r"(-?\d+)(?:-(-?\d+)(?:[x:](\d+))?)?")
_PLACE = re.compile(r"#+|%0?([1-9]?)d")
_MOST_FRAMES = 1_000_000


def parse_frames(text: str) -> list[int]:
    """``1-10x2,20`` (or ``1-10:2``): 1, 3, 5, 7, 9 and 20, ascending. Raises UsageError."""
    frames: set[int] = set()
    for part in text.split(","):
        match = _PART.fullmatch(part)
        if not match:
            raise UsageError(f"'{text}' is no list of frames like 1-10, 1-10x2 or 1,5,20-30")
        first = int(match[1])
        last, step = int(match[2] or first), int(match[3] or 1)
        if last < first or step < 1:
            raise UsageError(f"'{text}': '{part}' must rise by at least 1")
        if (last - first) // step + len(frames) >= _MOST_FRAMES:
            raise UsageError(f"'{text}' names more than a million frames")
        frames |= set(range(first, last + 1, step))
    return sorted(frames)


def frame_file(pattern: Path, frame: int) -> Path:
    """The pattern with the frame in the place of ``####`` or ``%04d``; as it is without one."""
    place = _PLACE.search(pattern.name)
    if not place:
        return pattern
    width = len(place[0]) if place[0].startswith("#") else int(place[1] or 1)
    name = pattern.name[: place.start()] + f"{frame:0{width}d}" + pattern.name[place.end() :]
    return pattern.with_name(name)


def frame_files(pattern: Path, frames: str | None) -> list[Path]:
    """The files of these frames, or the pattern's own without any. Raises UsageError."""
    if frames is None:
        return [pattern]
    numbers = parse_frames(frames)
    if len(numbers) > 1 and not _PLACE.search(pattern.name):
        raise UsageError(f"{pattern}: several frames need a place in the name, like ####")
    return [frame_file(pattern, number) for number in numbers]
