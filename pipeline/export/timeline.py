# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Truth values over the frames, as USD holds them: each sample lasts until the next."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Timeline:
    """``values[i]`` from ``times[i]`` (USD time codes, ascending) on; the first from the start."""

    times: tuple[float, ...]
    values: tuple[bool, ...]

    def at(self, time: float) -> bool:
        return self.values[max(bisect_right(self.times, time) - 1, 0)]

    @property
    def changes(self) -> bool:
        return len(self.times) > 1

    @property
    def never(self) -> bool:
        return not any(self.values)

    def both(self, other: Timeline) -> Timeline:
        """True where both are."""
        if self is other or (not self.changes and self.values[0]):
            return other
        if not other.changes and other.values[0]:
            return self
        times = tuple(sorted({*self.times, *other.times}))
        return Timeline(times, tuple(self.at(t) and other.at(t) for t in times))


ALWAYS = Timeline((float("-inf"),), (True,))
