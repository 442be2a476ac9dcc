# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Monte Carlo against the truth: the three conditions, by hand and with planted errors."""

from __future__ import annotations

import numpy as np
import pytest

from nightcity.chart.agreement import agreement, beyond_bound, sidak_bound


def test_by_hand() -> None:
    found = agreement(np.array([1.2, 3.0]), np.array([0.1, 0.1]), np.array([1.0, 3.0]))
    assert found.pixels == 2
    assert found.ratio == pytest.approx(4.2 / 4)
    assert found.ratio_error == pytest.approx(np.sqrt(0.02) / 4)
    assert found.worst == pytest.approx(2.0)


def test_sidak_bound() -> None:
    # One number: 2.5758 is passed with 1 %. A hundred: each with 1 - 0.99^(1/100) = 1.00e-4.
    assert sidak_bound(1) == pytest.approx(2.5758, abs=1e-4)
    assert sidak_bound(100) == pytest.approx(3.889, abs=1e-3)
    assert sidak_bound(2000) > sidak_bound(300)


def normal_estimates(seed: int, error: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    random = np.random.default_rng(seed)
    truth = random.uniform(1, 3, 2000)
    errors = error * truth
    return truth + errors * random.standard_normal(2000), errors, truth


def test_honest_noise_agrees() -> None:
    assert agreement(*normal_estimates(4, 0.02)).faults == []


def test_one_percent_too_much_light_is_found() -> None:
    value, error, truth = normal_estimates(4, 0.02)
    assert any("means" in fault for fault in agreement(1.01 * value, error, truth).faults)


def test_one_wrong_pixel_is_found() -> None:
    value, error, truth = normal_estimates(4, 0.02)
    value[7] += 7 * error[7]
    assert agreement(value, error, truth).faults == ["a pixel beyond the bound"]
    assert list(np.flatnonzero(beyond_bound(value, error, truth))) == [7]


def test_noise_that_says_little_is_refused() -> None:
    faults = agreement(*normal_estimates(4, 0.5)).faults
    assert [fault for fault in faults if "take more samples" in fault]


def test_dark_pixels_count_in_the_mean_alone() -> None:
    # The last has found no path and knows no error; it is below 1 % of the median.
    value, error = np.array([2.0, 2.0, 0.0]), np.array([0.1, 0.1, 0.0])
    found = agreement(value, error, np.array([2.0, 2.0, 0.001]))
    assert found.worst == 0
    assert found.ratio == pytest.approx(4 / 4.001)


def test_a_bright_pixel_without_light_is_found() -> None:
    found = agreement(np.array([2.0, 0.0]), np.array([0.1, 0.0]), np.array([2.0, 2.0]))
    assert found.worst == np.inf
