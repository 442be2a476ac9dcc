# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""recommendations.csv: what each shot needs for each tolerance, one row each."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path

from nightcity.chart.needs import Needs
from nightcity.chart.needs_text import short_options
from nightcity.chart.recommend import Recommendation
from nightcity.chart.shot import Shot
from nightcity.whole_file import whole_file

COLUMNS = (
    *("scene", "camera", "size", "against", "tolerance", "setting", "steady_frame_ms"),
    *("error", "pixels", "truth_noise", "verdict", "cheaper", "options"),
)


def write_recommendations(needs: Mapping[Shot, Needs], path: Path) -> None:
    """Errors as shares, at the pixels that the choice has not seen; empty where not rendered."""
    with whole_file(path) as pending, pending.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        for shot, found in needs.items():
            for each in found.recommendations:
                table.writerow([_text(value) for value in _row(shot, each)])


def _row(shot: Shot, found: Recommendation) -> tuple[object, ...]:
    chosen = found.chosen
    frame_ms = chosen.steady_ms if chosen else found.frame_ms
    return (
        *(shot.scene.name, shot.camera, str(shot.size), found.model.name, found.tolerance),
        *(chosen.point.name if chosen else "not charted", frame_ms),
        *(found.error, found.pixels or None, found.truth_noise, _verdict(found)),
        *("; ".join(found.cheaper), " ".join(short_options(found.options))),
    )


def _verdict(found: Recommendation) -> str:
    if found.error is None:
        return "not rendered"
    return "holds" if found.error <= found.tolerance else "misses"


def _text(value: object) -> object:
    return f"{value:.6g}" if isinstance(value, float) else "" if value is None else value
