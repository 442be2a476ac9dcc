# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Settings timed in turn, round after round, so that a drift of the machine meets them all."""

from __future__ import annotations

import statistics
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from nightcity.chart.runs import Setting, Timing, time_frames
from nightcity.progress import Progress

ROUNDS = 3


@dataclass
class InTurn:
    """One setting's calls, a round each."""

    timings: list[Timing] = field(default_factory=list)

    @property
    def first(self) -> Timing:
        """Of the first round."""
        return self.timings[0]

    @property
    def steady_ms(self) -> float:
        """The median of the rounds."""
        return statistics.median(timing.steady_frame_ms for timing in self.timings)

    @property
    def spread_ms(self) -> float:
        """From the fastest to the slowest round."""
        steady = [timing.steady_frame_ms for timing in self.timings]
        return max(steady) - min(steady)

    def pass_ms(self, name: str) -> float:
        """The median of a pass; 0 where there is none of that name."""
        return statistics.median(timing.passes.get(name, 0.0) for timing in self.timings)


def time_in_turn(
    scene: Path,
    view: list[str],
    frames: Mapping[Setting, int],
    folder: Path,
    label: str,
    rounds: int = ROUNDS,
) -> dict[Setting, InTurn]:
    """Each setting once a round, so many frames a time (the camera moves on; the first is not
    counted)."""
    measured = {setting: InTurn() for setting in frames}
    with Progress(label, rounds * sum(frames.values())) as progress:
        for _ in range(rounds):
            for setting, count in frames.items():
                timing = time_frames(scene, view, setting, count, folder)
                measured[setting].timings.append(timing)
                progress.advance(count)
    return measured
