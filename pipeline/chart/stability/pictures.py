# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""One picture a sweep: every method's error along the axis, failures marked with their cause."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from nightcity.chart.stability.methods import METHODS
from nightcity.chart.stability.sweep import SIGMAS, Outcome, Sweep

_LEAST, _MOST = 1e-9, 1e7  # of the axis; exact zeros lie on its foot, what is no number on its top


def draw(sweep: Sweep, outcomes: Sequence[Outcome], stem: Path) -> list[Path]:
    """Draw the outcomes of one sweep; returns STEM.svg and STEM.png."""
    plt.rcParams["svg.hashsalt"] = "nightcity"  # the same numbers give the same bytes
    figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
    for outcome in outcomes:
        _curve(axes, outcome)
    if sweep.predicted is not None:
        points = np.array(sweep.axis.values)
        axes.plot(points, _shown(sweep.predicted(points)), ":", color="0.4", label="closed form")
    if sweep.bar > 0:
        axes.axhline(sweep.bar, color="0.4", linestyle="--", linewidth=1)
        axes.annotate(
            f"bar {sweep.bar:g}", (0, sweep.bar), xycoords=("axes fraction", "data"),
            xytext=(4, 3), textcoords="offset points", fontsize=8, color="0.4",
        )  # fmt: skip
    _label(axes, sweep)
    axes.legend(fontsize=8, loc="best")
    paths = [stem.with_suffix(".svg"), stem.with_suffix(".png")]
    figure.savefig(paths[0], metadata={"Date": None})
    figure.savefig(paths[1], dpi=110, metadata={"Software": None})
    plt.close(figure)
    return paths


def _shown(errors: np.ndarray) -> np.ndarray:
    sizes = np.where(np.isfinite(errors), np.abs(errors), _MOST)
    return np.clip(sizes, _LEAST, _MOST)


def _curve(axes: Axes, outcome: Outcome) -> None:
    method, errors = METHODS[outcome.method], outcome.errors
    sizes = _shown(errors.error)
    label = method.name
    if errors.noise.any():
        band = _shown(SIGMAS * errors.noise)
        axes.plot(outcome.points, band, ":", color=method.colour, linewidth=1)
        label += f" (dotted: {SIGMAS:g} standard errors)"
    axes.plot(
        outcome.points, sizes, "-", marker=method.marker, color=method.colour, label=label,
        markersize=6, linewidth=1.2,
    )  # fmt: skip
    beyond = errors.beyond_noise > outcome.sweep.bar
    if outcome.sweep.must_notice:
        beyond = ~beyond
        beyond[0] = not beyond[0]
    if not beyond.any():
        return
    axes.plot(
        outcome.points[beyond], sizes[beyond], "o", markersize=12, fillstyle="none",
        color=method.colour,
    )  # fmt: skip
    worst = int(np.argmax(np.where(beyond, errors.beyond_noise, -1)))
    failure = outcome.sweep.failures.get(outcome.method)
    right = worst < len(outcome.points) / 2
    axes.annotate(
        f"{method.name}: {failure.cause if failure else 'unexpected'}",
        (outcome.points[worst], sizes[worst]),
        xytext=(10 if right else -10, 8), textcoords="offset points", fontsize=8,
        color=method.colour, ha="left" if right else "right",
    )  # fmt: skip


def _label(axes: Axes, sweep: Sweep) -> None:
    positive = [v for v in sweep.axis.values if v != 0]
    if sweep.axis.scale == "symlog":
        axes.set_xscale("symlog", linthresh=min(map(abs, positive)), linscale=0.5)
    else:
        axes.set_xscale(sweep.axis.scale)
    if sweep.axis.names:
        axes.set_xticks(sweep.axis.values, sweep.axis.names, rotation=30, ha="right", fontsize=8)
    axes.set_yscale("log")
    low, high = axes.get_ylim()
    axes.set_ylim(max(low, 0.5 * _LEAST), max(high * 3, 2 * sweep.bar, 1e-6))
    axes.set(xlabel=sweep.axis.label, ylabel="relative error")
    axes.set_title(f"{sweep.title}\n", fontsize=12)
    axes.text(
        0.5, 1.02, f"against: {sweep.truth}", transform=axes.transAxes, fontsize=9, ha="center"
    )  # fmt: skip
    if axes.get_ylim()[0] <= _LEAST:
        axes.axhline(_LEAST, color="0.8", linewidth=1)
        axes.annotate(
            "exact", (1, _LEAST), xycoords=("axes fraction", "data"), xytext=(-4, 3),
            textcoords="offset points", fontsize=8, color="0.4", ha="right",
        )  # fmt: skip
    axes.grid(which="major", color="0.9")
