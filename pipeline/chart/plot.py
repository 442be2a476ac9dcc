# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The rows of a shot as SVG and PNG: numerical and total error against the frame's time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes

from nightcity.chart.paper_tables import FRAMES_PER_SECOND
from nightcity.chart.plot_labels import label_points, plain_logarithmic
from nightcity.chart.results import Row
from nightcity.chart.shot import Shot

COLOURS = {"march": "#c0504d", "gauss": "#2f6db5", "field": "#2e8b57", "path": "#8064a2"}
MARKERS = {"march": "s", "gauss": "o", "field": "D", "path": "^"}
STATISTIC = "p95"
NOTICEABLE = 0.02  # of an error: what a row must gain to be on the front
_TITLES = {"numerical": "against the same model, converged", "total": "against the full model"}


def front(rows: Sequence[Row], cost: str, error: str) -> list[Row]:
    """The rows that no other beats in both columns, by rising cost; each better than the one before
    by more than anybody sees."""
    best: list[Row] = []
    for row in sorted(rows, key=lambda row: (row[cost], row[error])):
        if not best or row[error] < (1 - NOTICEABLE) * best[-1][error]:
            best.append(row)
    return best


def plot_speed_accuracy(rows: Sequence[Row], shot: Shot, stem: Path) -> list[Path]:
    """Draw STEM.svg and STEM.png and return them."""
    plt.rcParams["svg.hashsalt"] = "nightcity"  # the same rows give the same bytes
    own = [row for row in rows if (row["scene"], row["camera"]) == (shot.scene.name, shot.camera)]
    figure, both = plt.subplots(1, 2, figsize=(12, 5.4), layout="constrained")
    fronts = [_draw(axes, own, kind) for axes, kind in zip(both, _TITLES, strict=True)]
    both[0].set_ylabel("relative error of the glow, 95 of 100 pixels, %")
    figure.suptitle(f"{shot.scene.name}, {shot.camera}, {shot.size}")
    handles, labels = both[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=7, fontsize=8)
    figure.draw_without_rendering()  # lays out: labels are placed in pixels
    for axes, best in zip(both, fronts, strict=True):
        label_points(axes, list(best), list(best.values()))
    paths = [stem.with_name(f"{stem.name}{ending}") for ending in (".svg", ".png")]
    figure.savefig(paths[0], metadata={"Date": None})
    figure.savefig(paths[1], dpi=120, metadata={"Software": None})
    plt.close(figure)
    return paths


def _draw(axes: Axes, rows: Sequence[Row], kind: str) -> dict[str, tuple[float, float]]:
    """Draws one plot; returns the front's places by their settings."""
    column = f"{kind}_centre_{STATISTIC}"
    judged = [row for row in rows if row.get(column)]
    for method, colour in COLOURS.items():
        series = [row for row in judged if row["method"] == method]
        if not series:
            continue
        axes.plot(
            [row["steady_frame_ms"] for row in series],
            [100 * row[column] for row in series],
            MARKERS[method],
            color=colour,
            label=method,
            alpha=0.85,
        )
    best = front(judged, "steady_frame_ms", column)
    places = {row["setting"]: (row["steady_frame_ms"], 100 * row[column]) for row in best}
    line = list(zip(*places.values(), strict=True)) or [(), ()]
    axes.step(*line, where="post", color="0.3", linewidth=1, label="front")
    _draw_paper(axes, judged, column)
    surface = next(row["steady_frame_ms"] for row in rows if row["method"] == "surface")
    axes.axvline(surface, color="0.5", linestyle="--", linewidth=1, label="surface frame")
    axes.set(xscale="log", yscale="log", xlabel="steady frame, ms", title=_TITLES[kind])
    for axis in (axes.xaxis, axes.yaxis):
        plain_logarithmic(axis)
    axes.grid(which="both", color="0.92")
    return places


def _draw_paper(axes: Axes, rows: Sequence[Row], column: str) -> None:
    errors = {row["setting"]: row[column] for row in rows}
    known = {
        1000 / rate: 100 * errors[f"march {steps}, steps outside"]
        for steps, rate in FRAMES_PER_SECOND.items()
        if f"march {steps}, steps outside" in errors
    }
    if known:
        label = "the paper's Table 1 (RTX 2080), our errors"
        axes.plot(list(known), list(known.values()), ":x", color="#b8860b", label=label)
