# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The weighted colours of windows: a field of parameters, and drawing from them."""

from __future__ import annotations

import numpy as np

from nightcity.city.checked_fields import Check, custom
from nightcity.city.model import FloatArray

Colours = tuple[tuple[float, ...], ...]


def colours_field(default: Colours) -> Colours:
    """A field of rows (red, green, blue, weight)."""
    return custom(
        default,
        Check(
            "colours of windows, a list of [red, green, blue, weight]; linear Rec. 709, they "
            "multiply the power; weight is how often",
            "",
            "each 0 to 1000",
            _accept,
        ),
    )


def draw_colours(colours: Colours, count: int, rng: np.random.Generator) -> FloatArray:
    """(count, 3) linear colours, each drawn as often as its weight says."""
    rows = np.array(colours)
    weights = rows[:, 3] / rows[:, 3].sum()
    return rows[rng.choice(len(rows), size=count, p=weights), :3]


def _accept(value: object) -> Colours:
    if not isinstance(value, list | tuple) or not value:
        raise ValueError("must be a list of [red, green, blue, weight]")
    colours = []
    for row in value:
        if not isinstance(row, list | tuple) or len(row) != 4:
            raise ValueError("must be a list of [red, green, blue, weight]")
        if any(isinstance(part, bool) or not isinstance(part, int | float) for part in row):
            raise ValueError("must hold numbers only")
        if not all(0 <= part <= 1000 for part in row):  # false for NaN too
            raise ValueError("is out of range")
        colours.append(tuple(float(part) for part in row))
    if sum(row[3] for row in colours) <= 0:
        raise ValueError("has no weight above 0")
    return tuple(colours)
