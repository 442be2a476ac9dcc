# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The prototypes of windows: a dark pane and a lit one a colour, shared by all instancers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from pxr import Sdf

from nightcity.city.model import FloatArray, IntArray, Windows
from nightcity.stage import layout
from nightcity.stage.attributes import PrimWriter
from nightcity.stage.materials import write_emissive_material

SAME_SIZE = 1e-6  # m; panes are one size where they differ by less
DARK = 0  # the prototype of windows that are off
_MOST_COLOURS = 16  # lit prototypes; more colours than that are shown by the nearest of fewer
_FINEST_LEVELS = 256
_DEFAULT_SIZE = (1.2, 1.5)  # m, where there is no window


@dataclass(frozen=True)
class Panes:
    """Prototype DARK is dark, prototype 1 + i shows ``colours[i]``; all are of one size.

    size: (2,) width and height, m. colours: (C, 3), the largest channel 1. levels: steps to
    which colours are rounded before they are looked up.
    """

    size: FloatArray
    colours: FloatArray
    levels: int

    @property
    def paths(self) -> list[Sdf.Path]:
        names = ["Dark", *(f"Lit_{index}" for index in range(len(self.colours)))]
        return [layout.WINDOW_PROTOTYPES.AppendChild(name) for name in names]

    def lit_indices(self, colours: FloatArray) -> IntArray:
        """Which prototype shows windows of these (N, 3) colours that are on, (N,)."""
        shown = _shown(colours, self.levels)
        return 1 + np.argmin(np.abs(shown[:, None] - self.colours[None]).sum(axis=2), axis=1)


def choose_panes(batches: Iterable[Windows]) -> Panes:
    """The most common size, and every colour, or fewer where there are too many."""
    sizes: Counter[tuple[int, int]] = Counter()
    colours = np.empty((0, 3))
    levels = _FINEST_LEVELS
    for windows in batches:
        if len(windows) == 0:
            continue
        steps = np.round(window_sizes(windows) / SAME_SIZE).astype(np.int64)
        for size, count in zip(*np.unique(steps, axis=0, return_counts=True), strict=True):
            sizes[tuple(size.tolist())] += int(count)
        colours = np.unique(np.concatenate([colours, _shown(windows.colours, levels)]), axis=0)
        while len(colours) > _MOST_COLOURS and levels > 1:
            levels //= 2
            colours = np.unique(_shown(colours, levels), axis=0)
    if not sizes:
        return Panes(np.array(_DEFAULT_SIZE), np.ones((1, 3)), levels)
    common = max(sizes, key=lambda size: (sizes[size], size))
    return Panes(np.array(common) * SAME_SIZE, colours[::-1], levels)


def window_sizes(windows: Windows) -> FloatArray:
    """Width and height, (N, 2) m."""
    halves = (windows.half_u, windows.half_v)
    return 2 * np.column_stack([np.linalg.norm(half, axis=1) for half in halves])


def write_panes(root: PrimWriter, panes: Panes) -> None:
    """Write the prototypes below a class, which no viewer draws on its own, and their looks."""
    looks = PrimWriter(root, layout.WINDOW_LOOKS.name, "Scope")
    holder = PrimWriter(root, layout.WINDOW_PROTOTYPES.name, "Scope", specifier=Sdf.SpecifierClass)
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
    points = 0.5 * corners * [*panes.size, 0]
    glows = np.concatenate([np.zeros((1, 3)), panes.colours])
    for path, glow in zip(panes.paths, glows, strict=True):
        pane = PrimWriter(holder, path.name, "Mesh", ["MaterialBindingAPI"])
        pane.set("points", points)
        pane.set("faceVertexCounts", [4])
        pane.set("faceVertexIndices", [0, 1, 2, 3])
        pane.set("subdivisionScheme", "none")
        pane.set("extent", [points[0], points[2]])
        pane.relate("material:binding", [write_emissive_material(looks, path.name, glow)])


def _shown(colours: FloatArray, levels: int) -> FloatArray:
    """Colours as viewers show them: the largest channel 1, rounded to ``levels`` steps."""
    largest = colours.max(axis=1, keepdims=True, initial=0.0)
    relative = np.divide(colours, largest, out=np.zeros_like(colours), where=largest > 0)
    return np.round(relative * levels) / levels
