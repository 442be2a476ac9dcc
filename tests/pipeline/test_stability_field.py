# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The field in the scenes where methods break: it knows panes alone."""

from __future__ import annotations

import pytest
from stability_suite import check, sweeps_of

from nightcity.chart.stability.lab import Lab
from nightcity.chart.stability.methods import METHODS, PLAIN, Model, NotAskedError
from nightcity.chart.stability.suite import SWEEPS
from nightcity.chart.stability.sweep import Sweep, run


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Lab:
    return Lab(tmp_path_factory.mktemp("lab"))


@pytest.mark.parametrize("sweep", sweeps_of("field"), ids=lambda sweep: sweep.name)
def test_field(sweep: Sweep, lab: Lab) -> None:
    check(sweep, lab, "field")


def test_only_panes_are_asked(lab: Lab) -> None:
    field = METHODS["field"]
    assert field.nearest(PLAIN) == Model(emitter="pane")
    assert METHODS["gauss"].nearest(PLAIN) == PLAIN
    for model in (PLAIN, Model(emitter="lambertian"), Model("none", "pane")):
        with pytest.raises(NotAskedError):
            field.arguments(model)
    courtyard = next(sweep for sweep in SWEEPS if sweep.name == "courtyard")
    assert run(courtyard, lab, field, quick=True) is None
