# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What a switch of the model costs: the same method with the same options, with it and without."""

from __future__ import annotations

import statistics
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from nightcity.chart.measure import Measured, ShotResults
from nightcity.chart.settings import Model


@dataclass(frozen=True)
class Ratio:
    """Of times with a switch to those without: the median of the rounds, and their range."""

    median: float
    lowest: float
    highest: float


@dataclass(frozen=True)
class Cost:
    """setting: the method and its options, which are the same with the switch and without.

    bake: of what is made once a scene; None where that takes less than a frame.
    """

    setting: str
    frame: Ratio
    bake: Ratio | None


def switch_cost(results: ShotResults, poorer: Model, richer: Model) -> Cost | None:
    """By the cheapest setting that both models were charted with; None where there is none."""
    pairs = list(_pairs(results, poorer, richer))
    if not pairs:
        return None
    without, with_it = min(pairs, key=lambda pair: pair[1].steady_ms)
    rounds = list(zip(without.timings, with_it.timings, strict=False))  # some are called once
    point = with_it.point
    baked = all(timing.bake_ms > timing.steady_frame_ms for timing in without.timings)
    return Cost(
        " ".join((point.method, *point.knobs)),
        _ratio(costly.steady_frame_ms / cheap.steady_frame_ms for cheap, costly in rounds),
        _ratio(costly.bake_ms / cheap.bake_ms for cheap, costly in rounds) if baked else None,
    )


def _ratio(rounds: Iterable[float]) -> Ratio:
    ratios = list(rounds)
    return Ratio(statistics.median(ratios), min(ratios), max(ratios))


def _pairs(
    results: ShotResults, poorer: Model, richer: Model
) -> Iterator[tuple[Measured, Measured]]:
    """Without the switch and with it, one setting each."""
    for without in results.charted:
        for with_it in results.charted:
            alike = (without.point.method, without.point.knobs) == (
                with_it.point.method,
                with_it.point.knobs,
            )
            if alike and (without.point.model, with_it.point.model) == (poorer, richer):
                yield without, with_it
