# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""results.csv: one row a setting of a shot. Times in ms, errors as shares, memory in bytes."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

import numpy as np

from nightcity.chart.errors import LUMINANCE, ErrorStatistics
from nightcity.chart.flip import mean_flip
from nightcity.chart.measure import KINDS, PLACES, Measured, ShotResults
from nightcity.chart.settings import RICHEST
from nightcity.errors import SceneError
from nightcity.whole_file import whole_file

Row = dict[str, Any]
STATISTICS = tuple(field.name for field in fields(ErrorStatistics) if field.name != "pixels")
_MODEL = ("lights", "visibility", "emitter", "scattering", "surfaces")
COLUMNS = (
    *("scene", "scene_hash", "renderer", "device", "camera", "size"),
    *("setting", "method", "model", *_MODEL, "options", "failure"),
    *("rounds", "steady_frame_ms", "spread_ms", "ratio_to_surface", "ratio_spread"),
    *("first_frame_ms", "bake_ms", "memory_bytes", "light_evaluations"),
    *("mean_noise", "pixel_noise", "truth_noise"),
    *(
        f"{kind}_{place}_{name}"
        for kind in KINDS
        for place in PLACES
        for name in ("pixels", *STATISTICS)
    ),
    *("numerical_flip", "total_flip"),
)
_TEXT = frozenset(COLUMNS[: COLUMNS.index("rounds")])


def make_rows(results: ShotResults, renderer: str) -> list[Row]:
    """The surface frame first, then every setting in its order."""
    shot = results.shot
    common: Row = {
        **{"scene": shot.scene.name, "scene_hash": shot.scene.hash, "renderer": renderer},
        **{"device": results.surface[0].device, "camera": shot.camera, "size": str(shot.size)},
    }
    times = [timing.steady_frame_ms for timing in results.surface]
    surface = {
        **common,
        **{"setting": "surface frame", "method": "surface", "options": "--media off"},
        **{"rounds": len(times), "steady_frame_ms": float(np.median(times))},
        **{"spread_ms": max(times) - min(times), "ratio_to_surface": 1.0, "ratio_spread": 0.0},
        "memory_bytes": results.surface[0].memory_bytes,
    }
    return [surface, *({**common, **_row(results, each)} for each in results.settings)]


def _row(results: ShotResults, measured: Measured) -> Row:
    point = measured.point
    row: Row = {
        **{"setting": point.name, "method": point.method, "model": point.model.name},
        **{name: getattr(point.model, name) for name in _MODEL},
        "options": " ".join([*point.model.options, "--method", point.method, *point.knobs]),
        "failure": measured.failure,
    }
    if not measured.timings:
        return row
    row |= _cost(measured)
    if measured.frame is not None:
        row |= _accuracy(results, measured)
    return row


def _cost(measured: Measured) -> Row:
    times = [timing.steady_frame_ms for timing in measured.timings]
    return {
        **{"rounds": len(times), "steady_frame_ms": measured.steady_ms},
        **{"spread_ms": max(times) - min(times)},
        "ratio_to_surface": float(np.median(measured.ratios)),
        "ratio_spread": max(measured.ratios) - min(measured.ratios),
        "first_frame_ms": measured.timings[0].first_frame_ms,
        "bake_ms": float(np.median([timing.bake_ms for timing in measured.timings])),
        "memory_bytes": measured.timings[0].memory_bytes,
        "light_evaluations": measured.timings[0].light_evaluations,
    }


def _accuracy(results: ShotResults, measured: Measured) -> Row:
    assert measured.frame is not None
    row: Row = {}
    for kind in KINDS:
        for place in PLACES:
            errors = asdict(results.errors(measured, kind, place))
            row |= {f"{kind}_{place}_{name}": value for name, value in errors.items()}
        model = measured.point.model if kind == "numerical" else RICHEST
        truth = results.truths[model.name].image
        row[f"{kind}_flip"] = mean_flip(measured.frame.thinned(), truth)
    glow, error = measured.frame.at(results.pixels)
    glow, error = glow @ LUMINANCE, error @ LUMINANCE
    row["mean_noise"] = float(np.sqrt(np.sum(error**2)) / max(glow.sum(), np.finfo(float).tiny))
    row["pixel_noise"] = float(np.median(error / np.maximum(glow, np.finfo(float).tiny)))
    row["truth_noise"] = results.truth(RICHEST, "centre").noise
    return row


def write_rows(rows: Sequence[Row], path: Path) -> None:
    """All columns, in their order; what is not known stays empty."""
    with whole_file(path) as pending, pending.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        for row in rows:
            table.writerow([_cell(row.get(name, "")) for name in COLUMNS])


def _cell(value: object) -> object:
    return f"{value:.6g}" if isinstance(value, float) else value


def read_rows(path: Path) -> list[Row]:
    """A results.csv as it was written; SceneError names what is missing."""
    with path.open(newline="") as file:
        lines = list(csv.DictReader(file))
    if not lines or not {"setting", "ratio_to_surface"} <= set(lines[0]):
        raise SceneError(f"{path}: is no results.csv of 'nightcity chart', or holds no row")
    try:
        return [{name: _value(name, text) for name, text in line.items()} for line in lines]
    except ValueError as error:
        raise SceneError(f"{path}: {error}") from None


def _value(name: str, text: str | None) -> Any:
    if name in _TEXT:
        return text or ""
    return float(text) if text else None
