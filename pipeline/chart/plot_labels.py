# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Words in a logarithmic plot: ticks that say their number, labels that leave each other room."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from matplotlib.transforms import Bbox

# Up to so many decades these are named of each.
_NAMED = ((1.0, (1.0, 2.0, 3.0, 5.0, 7.0)), (3.0, (1.0, 2.0, 5.0)), (math.inf, (1.0,)))
# Where a label may lie about its point: offsets in points, and its alignment.
_OFFSETS = tuple(
    (x, y, "left" if x > 0 else "right") for y in (5, -12, 16, -23, 27, -34) for x in (6, -6)
)


def plain_logarithmic(axis: Axis) -> None:
    """Ticks like 0.5 and 20 instead of powers of ten; once the axis has its limits."""
    low, high = axis.get_view_interval()
    named = next(subs for decades, subs in _NAMED if math.log10(high / low) <= decades)
    axis.set_major_locator(LogLocator(subs=named, numticks=20))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def label_points(
    axes: Axes, names: Sequence[str], places: Sequence[tuple[float, float]]
) -> list[Bbox]:
    """Write each name beside its place, where it covers no other label and stays in the plot.

    To be called once the figure is laid out; returns the labels' boxes, in pixels.
    """
    taken: list[Bbox] = []
    for name, place in zip(names, places, strict=True):
        label = axes.annotate(name, place, (0, 0), textcoords="offset points", fontsize=7)
        frame = axes.get_window_extent()
        boxes = []
        for x, y, side in _OFFSETS:
            label.set(position=(x, y), horizontalalignment=side)
            box = label.get_window_extent()
            inside = frame.containsx(box.x0) and frame.containsx(box.x1)
            boxes.append((box.count_overlaps(taken) + (0 if inside else 1), len(boxes), box))
        _, best, box = min(boxes, key=lambda each: each[:2])
        x, y, side = _OFFSETS[best]
        label.set(position=(x, y), horizontalalignment=side)
        taken.append(box)
    return taken
