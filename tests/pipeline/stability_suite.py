# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests of the stability sweeps share: which sweeps a method runs, and the verdict."""

from __future__ import annotations

import numpy as np

from nightcity.chart.stability.lab import Lab
from nightcity.chart.stability.methods import METHODS, known_methods
from nightcity.chart.stability.suite import SWEEPS
from nightcity.chart.stability.sweep import Sweep, run

# A process of the path tracer needs a second to start: what these ask of it others ask as well.
_NOT_OF_PATH = {
    *("march-rings-aligned", "march-rings-staggered", "march-steps", "slices", "power"),
    *("eye-distance", "image-size", "moved-stage", "box-size", "halo-depth", "eye-height"),
    *("dolly", "grazing-haze", "light-order", "list-seam", "pane-onto"),
}


def sweeps_of(method: str) -> list[Sweep]:
    """Those that the tests ask of a method; none where the renderer does not know it."""
    if method not in known_methods():
        return []
    return [
        sweep
        for sweep in SWEEPS
        if method in sweep.methods
        and not (method == "path" and sweep.name in _NOT_OF_PATH)
        # The judge is the reference itself.
        and not (method == "reference" and "judge" in sweep.truth and not sweep.must_notice)
    ]


def check(sweep: Sweep, lab: Lab, method: str) -> None:
    """The sweep holds at its quick points, or fails as it is known to: by about the known size."""
    outcome = run(sweep, lab, METHODS[method], quick=True)
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
