# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Perlin noise: zero on the lattice, bounded, smooth, seeded, similar nearby."""

from __future__ import annotations

import numpy as np

from nightcity.city.perlin import PERIOD, noise, permutation


def samples(count=200_000, seed=5):
    rng = np.random.default_rng(seed)
    return rng.uniform(-300, 300, (2, count))


def test_zero_at_lattice_points():
    i, j = np.meshgrid(np.arange(-5, 300), np.arange(-5, 300))
    assert np.abs(noise(i, j, permutation(1))).max() == 0


def test_range_is_used_and_kept():
    values = noise(*samples(), permutation(1))
    assert np.abs(values).max() <= 1
    assert values.max() > 0.9 and values.min() < -0.9
    assert abs(values.mean()) < 0.01


def test_extreme_is_one_where_all_four_gradients_meet():
    """In the middle of a cell each corner weighs a quarter and its gradient, at best along the
    diagonal, gives sqrt(1/2): scaled, 1. No table gives more."""
    middles = np.arange(PERIOD) + 0.5
    values = [noise(middles, middles[:, None], permutation(seed)) for seed in range(20)]
    assert np.max(values) == 1 or 0.95 < np.max(values) < 1


def test_value_and_slope_are_continuous_across_cells():
    table, y, step = permutation(2), np.linspace(0, 50, 5001), 1e-5
    for x in (3.0, 17.0, -4.0):
        before, at, after = (noise(x + k * step, y, table) for k in (-1, 0, 1))
        np.testing.assert_allclose(before, at, atol=5 * step)
        np.testing.assert_allclose(at - before, after - at, atol=50 * step**2)


def test_similar_nearby_and_independent_far_away():
    x, y = samples()
    table = permutation(3)
    here = noise(x, y, table)

    def correlation(distance):
        return np.corrcoef(here, noise(x + distance, y, table))[0, 1]

    assert correlation(0.1) > 0.9
    assert abs(correlation(7.3)) < 0.02


def test_repeats_with_its_period_and_differs_by_seed():
    x, y = samples(1000)
    np.testing.assert_allclose(
        noise(x, y, permutation(4)), noise(x + PERIOD, y - PERIOD, permutation(4)), atol=1e-10
    )
    assert np.abs(noise(x, y, permutation(4)) - noise(x, y, permutation(5))).max() > 0.5


def test_permutation_holds_every_number_once():
    assert sorted(permutation(9)) == list(range(PERIOD))
    assert permutation(9).tolist() == permutation(9).tolist()
