# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of measured rows, as SVG and PNG."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

if TYPE_CHECKING:
    from nightcity.chart.speed_accuracy import Row

_MARKERS = {"steps": ("s", "#c0504d"), "lights": ("o", "#2f6db5")}
_LABELS = {"steps": "march as the paper has it", "lights": "march, light loop outside"}


def plot_speed_accuracy(rows: Sequence[Row], stem: Path) -> list[Path]:
    """Draw median and 99th-percentile error against frame time; returns STEM.svg and STEM.png."""
    plt.rcParams["svg.hashsalt"] = "nightcity"  # the same rows give the same bytes
    figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
    for order, (marker, colour) in _MARKERS.items():
        series = [
            row for row in rows if row.error and row.setting.name.endswith(f"{order} outside")
        ]
        times = [row.timing.steady_frame_ms for row in series]
        for share, style, name in (("median", "-", "median"), ("p99", ":", "99th percentile")):
            errors = [100 * getattr(row.error, share) for row in series]
            label = f"{_LABELS[order]}: {name}"
            axes.plot(times, errors, style, marker=marker, color=colour, label=label)
        for row in series:
            axes.annotate(
                row.setting.name.split(",")[0].removeprefix("march-"),
                (row.timing.steady_frame_ms, 100 * row.error.p99),
                textcoords="offset points",
                xytext=(6, 5),
                fontsize=8,
                color=colour,
            )
    surface = next(row.timing.steady_frame_ms for row in rows if row.error is None)
    axes.axvline(surface, color="0.5", linestyle="--", linewidth=1, label="surface frame")
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="steady frame, ms",
        ylabel="relative error of the glow, % (same model, converged)",
        title="Speed against accuracy: steps a segment",
    )
    axes.grid(which="both", color="0.9")
    axes.legend(fontsize=8)
    paths = [stem.with_suffix(".svg"), stem.with_suffix(".png")]
    figure.savefig(paths[0], metadata={"Date": None})
    figure.savefig(paths[1], dpi=120, metadata={"Software": None})
    plt.close(figure)
    return paths
