# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""How far a city reaches."""

from __future__ import annotations

import numpy as np

from nightcity.city.model import City, FloatArray


def city_bounds(city: City) -> tuple[FloatArray, FloatArray]:
    """Lower and upper corner, (3,) m each, of buildings and media; the origin where empty."""
    lo = [np.asarray(box.lo, float) for box in city.media]
    hi = [np.asarray(box.hi, float) for box in city.media]
    for building in city.buildings:
        if len(building.mesh.positions):
            lo.append(building.mesh.positions.min(axis=0) + building.origin)
            hi.append(building.mesh.positions.max(axis=0) + building.origin)
    if not lo:
        return np.zeros(3), np.zeros(3)
    return np.min(lo, axis=0), np.max(hi, axis=0)
