# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The windows layer: one PointInstancer a building, and the panes that all of them share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from pxr import Gf, Sdf

from nightcity.city.model import Building, City, FloatArray, IntArray, Windows
from nightcity.progress import Progress
from nightcity.stage import layout
from nightcity.stage.attributes import PrimWriter
from nightcity.stage.materials import write_emissive_material
from nightcity.stage.orientation import orientations

_MOST_COLOURS = 16  # lit prototypes; more colours than that are shown by the nearest of fewer
_SAME_SIZE = 1e-6  # m; panes are one size where they differ by less
_DEFAULT_SIZE = (1.2, 1.5)  # m, where there is no window


@dataclass(frozen=True)
class Panes:
    """The prototypes: a dark pane, then one a colour, all of one size.

    size: (2,) width and height, m. colours: (C, 3), the largest channel 1. levels: steps to
    which colours are rounded before they are looked up. paths: (1 + C,).
    """

    size: FloatArray
    colours: FloatArray
    levels: int
    paths: list[Sdf.Path]

    def indices(self, windows: Windows) -> IntArray:
        """Which prototype shows each window, (N,)."""
        shown = _shown(windows.colours, self.levels)
        nearest = np.argmin(np.abs(shown[:, None] - self.colours[None]).sum(axis=2), axis=1)
        return np.where(windows.light_on, 1 + nearest, 0)


def write_windows(city: City, layer: Sdf.Layer) -> None:
    """Write the windows of every building into an empty layer, over the geometry layer's prims."""
    root = layout.city_prim(layer)
    panes = _write_panes(city, root)
    over = Sdf.SpecifierOver
    buildings = PrimWriter(root, layout.BUILDINGS.name, specifier=over)
    with Progress("writing windows", len(city.buildings)) as progress:
        for name, members in layout.groups(city.buildings):
            group = PrimWriter(buildings, name, specifier=over)
            for building in members:
                if len(building.windows):
                    holder = PrimWriter(group, layout.building_name(building), specifier=over)
                    _write_instancer(holder, building.windows, panes)
            progress.advance(len(members))


def _write_instancer(holder: PrimWriter, windows: Windows, panes: Panes) -> None:
    prim = PrimWriter(holder, "Windows", "PointInstancer", ["NightcityWindowsAPI"])
    prim.set("positions", windows.centres)
    prim.set("orientationsf", orientations(windows.half_u, windows.half_v))
    sizes = _sizes(windows)
    if np.abs(sizes - panes.size).max() > _SAME_SIZE:
        prim.set("scales", np.column_stack([sizes / panes.size, np.ones(len(windows))]))
    prim.set("ids", windows.ids)
    prim.set("protoIndices", panes.indices(windows))
    prim.relate("prototypes", panes.paths)
    reach = np.abs(windows.half_u) + np.abs(windows.half_v)
    corners = [(windows.centres - reach).min(axis=0), (windows.centres + reach).max(axis=0)]
    prim.set("extent", corners)
    prim.set("nightcity:lightOn", _once(windows.light_on))
    prim.set("nightcity:power", _once(windows.power))
    prim.set("nightcity:color", _once(windows.colours))
    prim.set("nightcity:windowSize", Gf.Vec2f(*map(float, panes.size)))


def _once(values: np.ndarray) -> np.ndarray:
    """One value for all where all are equal."""
    return values[:1] if (values == values[0]).all() else values


def _sizes(windows: Windows) -> FloatArray:
    """Width and height, (N, 2) m."""
    halves = (windows.half_u, windows.half_v)
    return 2 * np.column_stack([np.linalg.norm(half, axis=1) for half in halves])


def _shown(colours: FloatArray, levels: int) -> FloatArray:
    """Colours as viewers show them: the largest channel 1, rounded to ``levels`` steps."""
    largest = colours.max(axis=1, keepdims=True, initial=0.0)
    relative = np.divide(colours, largest, out=np.zeros_like(colours), where=largest > 0)
    return np.round(relative * levels) / levels


def _glazed(city: City) -> list[Building]:
    return [building for building in city.buildings if len(building.windows)]


def _palette(city: City) -> tuple[FloatArray, int]:
    """At most _MOST_COLOURS colours for the lit panes, and the levels that they are rounded to."""
    levels = 256
    while True:
        found = [
            np.unique(_shown(building.windows.colours, levels), axis=0)
            for building in _glazed(city)
        ]
        colours = np.unique(np.concatenate([*found, np.empty((0, 3))]), axis=0)
        if len(colours) <= _MOST_COLOURS or levels == 1:
            return colours[::-1], levels
        levels //= 2


def _common_size(city: City) -> FloatArray:
    """The size that most windows have, (2,) m."""
    tally: dict[tuple[float, float], int] = {}
    for building in _glazed(city):
        rounded = np.round(_sizes(building.windows) / _SAME_SIZE).astype(np.int64)
        for size, count in zip(*np.unique(rounded, axis=0, return_counts=True), strict=True):
            key = tuple(size.tolist())
            tally[key] = tally.get(key, 0) + int(count)
    if not tally:
        return np.array(_DEFAULT_SIZE)
    return np.array(max(tally, key=lambda size: (tally[size], size))) * _SAME_SIZE


def _write_panes(city: City, root: PrimWriter) -> Panes:
    """The prototypes, below a class, which no viewer draws on its own."""
    size = _common_size(city)
    colours, levels = _palette(city)
    looks = PrimWriter(root, layout.WINDOW_LOOKS.name, "Scope")
    holder = PrimWriter(root, layout.WINDOW_PROTOTYPES.name, "Scope", specifier=Sdf.SpecifierClass)
    names = ["Dark", *(f"Lit_{index}" for index in range(len(colours)))]
    glows = np.concatenate([np.zeros((1, 3)), colours])
    paths = []
    for name, glow in zip(names, glows, strict=True):
        pane = PrimWriter(holder, name, "Mesh", ["MaterialBindingAPI"])
        half = 0.5 * size
        signs = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
        points = signs * [*half, 0]
        pane.set("points", points)
        pane.set("faceVertexCounts", [4])
        pane.set("faceVertexIndices", [0, 1, 2, 3])
        pane.set("subdivisionScheme", "none")
        pane.set("extent", [points[0], points[2]])
        pane.relate("material:binding", [write_emissive_material(looks, name, glow)])
        paths.append(pane.path)
    return Panes(size, colours, levels, paths)
