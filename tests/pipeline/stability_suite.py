# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests of the stability sweeps share: which sweeps a method runs, and the verdict."""

from __future__ import annotations

import numpy as np

from nightcity.chart.stability.lab import Lab
from nightcity.chart.stability.methods import METHODS, known_methods
from nightcity.chart.stability.suite import SWEEPS
from nightcity.chart.stability.sweep import Sweep, run

# The path tracer needs a second to start, gauss two: of these the tests ask only what other sweeps
# do not ask as well. The chart asks all.
_NOT_OF_DEVICE = {
    *("march-rings-aligned", "march-rings-staggered", "march-steps", "box-size", "halo-depth"),
    *("eye-height", "grazing-haze", "image-size", "list-seam", "light-order", "moved-stage"),
    *("pane-onto", "power"),
}
_NOT_ASKED = {
    "path": _NOT_OF_DEVICE | {"slices", "eye-distance", "dolly"},
    "gauss": _NOT_OF_DEVICE
    | {"lambertian-distance", "moved-scene", "multiple-scattering", "mutants", "seeds"}
    | {"switched", "unit-scale"},
}
# The field knows panes alone, and takes two seconds and a bake for each.
_ASKED = {"field": {"cut-haze", "grazing-haze", "pane-onto", "thin-slab"}}


def sweeps_of(method: str) -> list[Sweep]:
    """Those that the tests ask of a method; none where the renderer does not know it."""
    if method not in known_methods():
        return []
    return [
        sweep
        for sweep in SWEEPS
        if method in sweep.methods
        and sweep.name not in _NOT_ASKED.get(method, ())
        and sweep.name in _ASKED.get(method, {sweep.name})
        # The judge is the reference itself.
        and not (method == "reference" and "judge" in sweep.truth and not sweep.must_notice)
    ]


def check(sweep: Sweep, lab: Lab, method: str) -> None:
    """The sweep holds at its quick points, or fails as it is known to: by about the known size."""
    outcome = run(sweep, lab, METHODS[method], quick=True)
    assert outcome is not None, f"{sweep.name}: {method} does not know its physics"
    failure = sweep.failures.get(method)
    found = f"{sweep.name}: {outcome.errors.error} +- {outcome.errors.noise} {outcome.fault}"
    if failure is None:
        assert outcome.holds, f"{found}: above {sweep.bar}"
    else:
        range_ = f"{failure.least} to {failure.most} ({failure.cause})"
        assert failure.least <= outcome.errors.worst <= failure.most, f"{found}: not {range_}"
    if sweep.predicted is not None and method == "march":
        predicted = sweep.predicted(outcome.points)
        np.testing.assert_allclose(outcome.errors.error, predicted, rtol=0.01, atol=1e-4)
