# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What values the attributes of the schemas may have: the one table that validation reads.

A test holds it against the docs in schemas/schema.usda.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Range:
    """low, high: inclusive, unless ``above``, which excludes low. unset: a value that stands for
    none. required: the attribute must have a value of its own, its default means nothing."""

    low: float = -np.inf
    high: float = np.inf
    above: bool = False
    unset: float | None = None
    required: bool = False

    def __str__(self) -> str:
        if np.isfinite(self.high):
            return f"{self.low:g} to {self.high:g}"
        if self.above:
            return f"above {self.low:g}"
        return f"{self.low:g} and up" if np.isfinite(self.low) else "finite"

    def broken(self, values: np.ndarray) -> np.ndarray:
        """The values outside, of any shape; NaN and infinity always are."""
        values = np.asarray(values).ravel()
        inside = np.isfinite(values) & (values <= self.high)
        inside &= values > self.low if self.above else values >= self.low
        if self.unset is not None:
            inside |= values == self.unset
        return values[~inside]


RANGES: dict[str, Range] = {
    "nightcity:originOffset": Range(),
    "nightcity:buildingId": Range(low=0, unset=-1),
    "nightcity:power": Range(low=0),
    "nightcity:color": Range(low=0),
    "nightcity:windowSize": Range(low=0, above=True),
    "nightcity:mediaId": Range(low=0, required=True),
    "nightcity:extinction": Range(low=0),
    "nightcity:albedo": Range(low=0, high=1),
    "nightcity:reachScale": Range(low=0, above=True),
}
