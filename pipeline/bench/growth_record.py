# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What ``nightcity bench growth`` has measured, kept after every step so that it can go on."""

from __future__ import annotations

import csv
import json
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from nightcity.errors import NightcityError, UsageError

_LARGER_HALF = 3  # a slope needs so many cities; below some size start-up time is all there is


@dataclass(frozen=True)
class LeftOut:
    """A step that no city from ``grid`` on tries again."""

    grid: int
    reason: str


@dataclass
class Growth:
    """cities: what each holds and costs by column name, seconds and bytes, by ascending size.
    left_out: by step. Columns of a step begin with its name."""

    cities: list[dict[str, float]] = field(default_factory=list)
    left_out: dict[str, LeftOut] = field(default_factory=dict)

    def city(self, grid: int) -> dict[str, float]:
        """The row of a city, made where there is none."""
        for city in self.cities:
            if city["grid"] == grid:
                return city
        self.cities.append({"grid": grid})
        self.cities.sort(key=lambda city: city["grid"])
        return self.city(grid)

    def columns(self, ending: str) -> list[str]:
        """Names of the columns that end so, in the order in which they came up."""
        names = dict.fromkeys(name for city in self.cities for name in city)
        return [name for name in names if name.endswith(ending)]

    def series(self, column: str) -> tuple[np.ndarray, np.ndarray]:
        """Windows and values of the cities that have the column."""
        rows = [city for city in self.cities if city.get(column, 0) > 0]
        return (
            np.array([city["windows"] for city in rows], float),
            np.array([city[column] for city in rows], float),
        )

    def slope(self, column: str) -> float:
        """Exponent with which a column follows the number of windows: a line through the larger
        half of the cities, three at least, on logarithmic axes; NaN for fewer."""
        windows, values = self.series(column)
        if len(values) < _LARGER_HALF:
            return math.nan
        last = slice(-max(_LARGER_HALF, (len(values) + 1) // 2), None)
        return float(np.polyfit(np.log(windows[last]), np.log(values[last]), 1)[0])


def read_growth(path: Path, settings: Mapping[str, object]) -> Growth:
    """What an earlier run kept in ``path``; empty where there was none.

    Raises UsageError where that run had other settings, NightcityError where the file is broken.
    """
    if not path.is_file():
        return Growth()
    try:
        kept = json.loads(path.read_text())
        found = Growth(
            kept["cities"],
            {name: LeftOut(**left) for name, left in kept["left_out"].items()},
        )
        earlier = kept["settings"]
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise NightcityError(
            f"{path}: cannot be read as an earlier run ({error}); remove it"
        ) from None
    if earlier != dict(settings):
        raise UsageError(
            f"{path} holds a run of other settings, {earlier}; choose another folder, or remove it"
        )
    return found


def write_growth(found: Growth, path: Path, settings: Mapping[str, object]) -> None:
    """Keep everything in ``path``, and the cities in a table of the same name, .csv."""
    left_out = {name: vars(left) for name, left in found.left_out.items()}
    kept = {"settings": dict(settings), "cities": found.cities, "left_out": left_out}
    part = path.with_suffix(".part")
    part.write_text(json.dumps(kept, indent=1) + "\n")
    os.replace(part, path)
    names = dict.fromkeys(name for city in found.cities for name in city)
    with path.with_suffix(".csv").open("w", newline="") as file:
        table = csv.DictWriter(file, list(names), lineterminator="\n")
        table.writeheader()
        table.writerows(found.cities)
