# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Gradient noise in the plane: values that are similar nearby.

K. Perlin, "Improving Noise", SIGGRAPH 2002: the quintic fade, whose second derivative is
continuous, and gradients from a small set of evenly spread directions.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from nightcity.city.model import FloatArray, IntArray

PERIOD = 256  # lattice cells after which the noise repeats

_ANGLES = np.arange(8) * (np.pi / 4)
_GRADIENTS = np.column_stack([np.cos(_ANGLES), np.sin(_ANGLES)])


def permutation(seed: int | np.random.SeedSequence) -> IntArray:
    """A seeded shuffle of 0 ... PERIOD - 1, which tells one noise from another."""
    return np.random.default_rng(seed).permutation(PERIOD)


def noise(x: ArrayLike, y: ArrayLike, table: IntArray) -> FloatArray:
    """Noise at (x, y), in lattice cells; the shape is that of x and y broadcast.

    From -1 to 1, zero where x and y are whole. table: from ``permutation``.
    """
    x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
    column, row = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    u, v = x - column, y - row

    def corner(i: int, j: int) -> FloatArray:
        hashed = table[(table[(column + i) % PERIOD] + row + j) % PERIOD]
        gradient = _GRADIENTS[hashed % len(_GRADIENTS)]
        return gradient[..., 0] * (u - i) + gradient[..., 1] * (v - j)

    fade_u, fade_v = _fade(u), _fade(v)
    low = corner(0, 0) + fade_u * (corner(1, 0) - corner(0, 0))
    high = corner(0, 1) + fade_u * (corner(1, 1) - corner(0, 1))
    # With unit gradients the extreme is sqrt(1/2), in the middle of a cell.
    return np.sqrt(2.0) * (low + fade_v * (high - low))


def _fade(t: FloatArray) -> FloatArray:
    return t * t * t * (t * (6.0 * t - 15.0) + 10.0)
