# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The windows layer: one PointInstancer a building."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

import numpy as np
from pxr import Gf, Sdf

from nightcity.city.model import Building, City, Windows
from nightcity.progress import Progress
from nightcity.stage import layout
from nightcity.stage.attributes import PrimWriter
from nightcity.stage.orientation import orientations
from nightcity.stage.panes import DARK, SAME_SIZE, Panes, choose_panes, window_sizes, write_panes

FIRST_FRAME = 1  # of every city


def write_windows(city: City, layer: Sdf.Layer) -> None:
    """Write the windows of every building into an empty layer, over the geometry layer's prims."""
    root = layout.city_prim(layer)
    panes = choose_panes(_joined(members) for _, members in layout.groups(city.buildings))
    write_panes(root, panes)
    over = Sdf.SpecifierOver
    buildings = PrimWriter(root, layout.BUILDINGS.name, specifier=over)
    with Progress("writing windows", len(city.buildings)) as progress:
        for name, members in layout.groups(city.buildings):
            _write_group(PrimWriter(buildings, name, specifier=over), members, panes)
            progress.advance(len(members))


def _joined(buildings: Sequence[Building]) -> Windows:
    """The windows of several buildings in one record: numpy is slow on small arrays."""
    return Windows(
        *(
            np.concatenate([getattr(building.windows, field.name) for building in buildings])
            for field in fields(Windows)
        )
    )


def _write_group(group: PrimWriter, buildings: Sequence[Building], panes: Panes) -> None:
    windows = _joined(buildings)
    if len(windows) == 0:
        return
    turns = orientations(windows.half_u, windows.half_v)
    lit = panes.lit_indices(windows.colours)
    shown = np.where(windows.light_on, lit, DARK)
    scales = window_sizes(windows) / panes.size
    scaled = (np.abs(scales - 1) * panes.size > SAME_SIZE).any(axis=1)
    scales = np.column_stack([scales, np.ones(len(windows))])
    reach = np.abs(windows.half_u) + np.abs(windows.half_v)
    lower, upper = windows.centres - reach, windows.centres + reach
    paths, size = panes.paths, Gf.Vec2f(*map(float, panes.size))
    start = 0
    for building in buildings:
        part = slice(start, start + len(building.windows))
        start = part.stop
        if not len(building.windows):
            continue
        holder = PrimWriter(group, layout.building_name(building), specifier=Sdf.SpecifierOver)
        prim = PrimWriter(holder, "Windows", "PointInstancer", ["NightcityWindowsAPI"])
        prim.relate("prototypes", paths)
        prim.set("positions", windows.centres[part])
        prim.set("orientationsf", turns[part])
        prim.set("orientations", turns[part])  # half precision, for tools that know no other
        if scaled[part].any():
            prim.set("scales", scales[part])
        prim.set("ids", windows.ids[part])
        prim.set("protoIndices", shown[part])
        prim.set("extent", [lower[part].min(axis=0), upper[part].max(axis=0)])
        prim.set("nightcity:lightOn", _once(windows.light_on[part]))
        _write_night(prim, building.windows, lit[part])
        prim.set("nightcity:power", _once(windows.power[part]))
        prim.set("nightcity:color", _once(windows.colours[part]))
        prim.set("nightcity:windowSize", size)


def _write_night(prim: PrimWriter, windows: Windows, lit: np.ndarray) -> None:
    """What shines from each frame on at which something changes, and what viewers show of it."""
    if len(windows.switches) == 0:
        return
    row, frame = windows.switches.T
    frames, place = np.unique(frame, return_inverse=True)
    changes = np.zeros((len(frames) + 1, len(windows)), dtype=bool)
    changes[0] = windows.light_on
    changes[place + 1, row] = True
    states = np.logical_xor.accumulate(changes)
    times = [FIRST_FRAME, *frames.tolist()]
    prim.sample("nightcity:lightOn", dict(zip(times, states, strict=True)))
    shown = np.where(states, lit, DARK)
    prim.sample("protoIndices", dict(zip(times, shown, strict=True)))


def _once(values: np.ndarray) -> np.ndarray:
    """One value for all where all are equal."""
    return values[:1] if (values == values[0]).all() else values
