# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The exact method on the device in the scenes where methods break."""

from __future__ import annotations

import pytest
from stability_suite import check, sweeps_of

from nightcity.chart.stability.lab import Lab
from nightcity.chart.stability.sweep import Sweep


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Lab:
    return Lab(tmp_path_factory.mktemp("lab"))


@pytest.mark.parametrize("sweep", sweeps_of("gauss"), ids=lambda sweep: sweep.name)
def test_gauss(sweep: Sweep, lab: Lab) -> None:
    check(sweep, lab, "gauss")
