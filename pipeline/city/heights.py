# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Heights of buildings from Perlin noise: similar nearby, and spread as the parameters ask."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nightcity.city import perlin
from nightcity.city.model import FloatArray, IntArray
from nightcity.city.parameters import CityParameters, snap
from nightcity.city.seeds import Purpose, generator, sequence


@dataclass(frozen=True)
class BuildingShapes:
    """heights: (rows, columns) m. window_rows: (rows, columns), rows of windows on a facade."""

    heights: FloatArray
    window_rows: IntArray


def building_shapes(parameters: CityParameters) -> BuildingShapes:
    """How tall every building is."""
    rank = noise_rank(parameters)
    if parameters.heights == "templates":
        big = rank >= 1.0 - parameters.big_share
        return BuildingShapes(
            np.where(big, snap(parameters.big_height), snap(parameters.small_height)),
            np.where(big, parameters.big_rows, parameters.small_rows),
        )
    low, high = parameters.min_height, parameters.max_height
    wanted = low + (high - low) * rank**parameters.height_exponent
    floors = np.maximum(
        np.floor(wanted / parameters.floor_height + 1e-9).astype(int), parameters.lowest_floors
    )
    # The ground line has no window; the paper's small building is one of six 5 m floors.
    heights = np.vectorize(snap, otypes=[float])(floors * parameters.floor_height)
    return BuildingShapes(heights, floors - 1)


def noise_rank(parameters: CityParameters) -> FloatArray:
    """(rows, columns): share of the buildings whose noise is lower, (rank + 0.5) / count.

    Ranks rather than raw noise, so that shares and ranges come out as asked for at any seed.
    """
    columns, rows = parameters.grid
    table = perlin.permutation(sequence(parameters.seed, Purpose.HEIGHTS))
    start = generator(parameters.seed, Purpose.NOISE_START).uniform(0, perlin.PERIOD, 2)
    x = start[0] + parameters.noise_frequency * np.arange(columns)
    y = start[1] + parameters.noise_frequency * np.arange(rows)[:, None]
    values = perlin.noise(x, y, table).ravel()
    rank = np.empty(values.size)
    rank[np.argsort(values, kind="stable")] = (np.arange(values.size) + 0.5) / values.size
    return rank.reshape(rows, columns)
