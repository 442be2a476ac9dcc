# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The night: which windows shine when, by what their building is used for.

A plausible evening, not a measured one. Rooms of homes shine from when people come home to when
they sleep, some with a break; those of offices until people leave, and again while a floor is
cleaned, a few all night; the windows of a stairwell shine for a few minutes at a time while homes
are up, and all night in offices. Every building has a random stream of its own.

Hours count on from noon: 26 is two in the morning.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from nightcity.city.checked_fields import Check, custom, integer, number
from nightcity.city.model import BoolArray, Building, FloatArray, IntArray, Windows
from nightcity.city.seeds import Purpose, stream

MOST_FRAMES = 100_000
_NOON, _DAY = 12.0, 24.0
_NEVER = np.inf

# Hours, mean and standard deviation.
_HOME_ON, _HOME_OFF = (18.2, 1.0), (23.0, 1.0)
_BREAK_SHARE, _BREAK_MEAN = 0.4, 0.7
_OFFICE_OFF = (18.6, 1.2)
_CLEANED_FROM, _CLEANED_TO, _CLEANING = 19.5, 23.0, 0.3
_ALL_NIGHT_SHARE = 0.03
_STAIR_VISITS, _STAIR_FROM, _STAIR_TO, _STAIR_LIGHT = 16, 17.0, 25.5, 0.07
_COLUMN = 0.1  # m; windows above one another belong to one stairwell


@dataclass(frozen=True)
class Night:
    """start, end: hours of the first and the last of ``frames`` frames, counted from 1.
    offices: share of the buildings. seed: of all of it."""

    start: float
    end: float
    frames: int
    offices: float
    seed: int

    def frame_of(self, hours: FloatArray) -> IntArray:
        """The first frame at each of the hours or after it, 1 at least, frames + 1 for later."""
        steps = (hours - self.start) * max(self.frames - 1, 1) / (self.end - self.start)
        return 1 + np.ceil(np.clip(steps, 0, self.frames)).astype(np.int64)


def time_field() -> str:
    """A field such as 18:00-02:00; empty: the night stands still."""
    return custom(
        "",
        Check(
            "hours that the frames span, in which windows go on and off by the use of their "
            "building; empty: they stay as they are",
            "",
            "like 18:00-02:00, between noon and noon",
            _accept_time,
            True,
        ),
    )


def frames_field() -> int:
    """How many frames the stage has."""
    return integer(
        1, 1, MOST_FRAMES, "frames; with more than one there are moving cameras, and time counts"
    )


def offices_field() -> float:
    """The share of offices."""
    return number(0.3, 0, 1, "share of the buildings that are offices, the others are homes (time)")


def night_of(time: str, frames: int, offices: float, seed: int) -> Night | None:
    """The night of these fields; None where it stands still."""
    return Night(*_hours(time), frames, offices, seed) if time else None


def with_night(buildings: Sequence[Building], night: Night | None) -> list[Building]:
    """The buildings with their windows over the night. Windows that are on are those in use; the
    others stay dark."""
    if night is None:
        return list(buildings)
    return [replace(each, windows=_over_night(each, night)) for each in buildings]


def _accept_time(value: object) -> str:
    if not isinstance(value, str):
        raise ValueError("must be text")
    if value:
        _hours(value)
    return value


def _hours(text: str) -> tuple[float, float]:
    match = re.fullmatch(r"(\d\d?):(\d\d)-(\d\d?):(\d\d)", text)
    if not match:
        raise ValueError("must be two times of the day")
    numbers = [int(part) for part in match.groups()]
    if max(numbers[0::2]) > _DAY - 1 or max(numbers[1::2]) > 59:
        raise ValueError("must be two times of the day")
    start, end = (hour + minute / 60 for hour, minute in (numbers[:2], numbers[2:]))
    start += _DAY * (start < _NOON)
    end += _DAY * (end < _NOON)
    if end <= start:
        raise ValueError("must end after it starts, and not span noon")
    return start, end


def _over_night(building: Building, night: Night) -> Windows:
    windows = building.windows
    rng = stream(night.seed, Purpose.NIGHT, building.building_id)
    if len(windows) == 0:
        return windows
    office = rng.random() < night.offices
    turns = (_office if office else _home)(windows, rng)
    stairs = _stairwell(windows, rng)
    visits = np.array([[-_NEVER, _NEVER]]) if office else _stair_visits(rng)
    turns = _padded(turns, visits.shape[1])
    turns[stairs] = _padded(visits, turns.shape[1])
    turns[~windows.light_on] = _NEVER
    return _switched(windows, night.frame_of(turns), night.frames)


def _home(windows: Windows, rng: np.random.Generator) -> FloatArray:
    """(N, 4) hours at which each window goes on, off, on and off."""
    count = len(windows)
    on, off = rng.normal(*_HOME_ON, count), rng.normal(*_HOME_OFF, count)
    off = np.maximum(on, off)
    leaves = on + (off - on) * rng.random(count)
    comes = np.minimum(leaves + rng.exponential(_BREAK_MEAN, count), off)
    stays = rng.random(count) >= _BREAK_SHARE
    leaves[stays] = comes[stays]
    return np.column_stack([on, leaves, comes, off])


def _office(windows: Windows, rng: np.random.Generator) -> FloatArray:
    """As for homes; the second time is when the floor is cleaned."""
    count = len(windows)
    off = np.where(rng.random(count) < _ALL_NIGHT_SHARE, _NEVER, rng.normal(*_OFFICE_OFF, count))
    floor = np.unique(np.round(windows.centres[:, 2], 1), return_inverse=True)[1]
    cleaned = rng.uniform(_CLEANED_FROM, _CLEANED_TO, floor.max() + 1)[floor]
    last = np.maximum(cleaned + _CLEANING, off)
    return np.column_stack([np.full(count, -_NEVER), off, np.maximum(cleaned, off), last])


def _stairwell(windows: Windows, rng: np.random.Generator) -> BoolArray:
    """(N,) the windows above and below one of them, on the same wall."""
    place = windows.centres[:, :2]
    chosen = place[rng.integers(len(place))]
    return (np.abs(place - chosen) < _COLUMN).all(axis=1)


def _stair_visits(rng: np.random.Generator) -> FloatArray:
    """(1, V) hours at which the light goes on and off."""
    on = np.sort(rng.uniform(_STAIR_FROM, _STAIR_TO, _STAIR_VISITS))
    off = np.minimum(on + _STAIR_LIGHT, np.append(on[1:], _NEVER))
    return np.column_stack([on, off]).reshape(1, -1)


def _padded(turns: FloatArray, width: int) -> FloatArray:
    more = max(width - turns.shape[1], 0)
    return np.pad(turns, ((0, 0), (0, more)), constant_values=_NEVER)


def _switched(windows: Windows, turns: IntArray, frames: int) -> Windows:
    """The windows as they are at frame 1, and what changes later. turns: (N, K) frames at which
    each turns on or off, in pairs; two at one frame cancel."""
    row = np.repeat(np.arange(len(turns)), turns.shape[1])
    frame = turns.ravel()
    key, count = np.unique((frame * len(turns) + row)[frame <= frames], return_counts=True)
    key = key[count % 2 == 1]
    frame, row = np.divmod(key, len(turns))
    light_on = np.zeros(len(turns), dtype=bool)
    light_on[row[frame == 1]] = True
    later = frame > 1
    return replace(windows, light_on=light_on, switches=np.column_stack([row[later], frame[later]]))
