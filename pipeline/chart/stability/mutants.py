# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes with a planted fault, which the bars of the sweeps must notice, bright or dark."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.stability.lab import Lab, Shot
from nightcity.chart.stability.methods import Method, Model
from nightcity.chart.stability.sweep import Axis, Errors, Sweep, joined, relative_errors
from nightcity.chart.stability.tiny_scene import TinyScene

FloatArray = NDArray[np.float64]

MUTANTS = ("none", "5 % of the lights dropped", "visibility ignored", "a box skipped",
           "power times 1.01")  # fmt: skip
_POINTS = tuple(range(len(MUTANTS)))


def _town(mutant: int, power: float) -> Shot:
    """A street of 40 lights in two boxes of haze, with one fault."""
    scene = TinyScene()
    scene.wall((-10, -20, 0), (-5, 20, 20))
    scene.wall((5, -20, 0), (10, 20, 20))
    scene.wall((-1, -4, 0), (1, 4, 14))
    watts = power * (1.01 if mutant == 4 else 1.0)
    for side in (-1, 1):
        for i in range(20):
            centre = (side * 4.75, -18 + 4 * (i % 10), 4 + 8 * (i // 10))
            if mutant != 1 or i != 7:
                scene.window(centre, normal=(-side, 0, 0), side=0.5, power=watts)
    for lo, hi in (((-32, -32, 0), (32, 0, 24)), ((-32, 0, 0), (32, 32, 24))):
        if mutant != 3 or lo[1] == 0:
            scene.haze(lo, hi, 0.02)
    for x in (-3, -1.5, 1.5, 3):  # not in the plane of a wall
        scene.look((x, -40, 6 + x), (0, 1, 0.1))
        scene.look((20, 4 * x, 40), (-20, 0.1, -22))
    return Shot(scene, Model(visibility="none" if mutant == 2 else "full"))


def _shot(points: FloatArray, power: float) -> Shot:
    return _town(int(points[0]), power)


_SHOTS = {power: partial(_shot, power=power) for power in (50.0, 0.05)}


def _noticed(power: float):
    def measure(lab: Lab, method: Method, points: FloatArray) -> Errors:
        """Of the sound scene (point 0) the error; of each mutant the error that a bar must see."""
        make = _SHOTS[power]
        truth = lab.judge(lab.shot(make, np.zeros(1))).by_point(1).value
        found = [lab.render(lab.shot(make, np.array([p])), method).by_point(1) for p in points]
        return joined([relative_errors(glow, truth) for glow in found])

    return measure


SWEEPS = tuple(
    Sweep(
        name=name,
        title=f"Planted faults, {light}",
        axis=Axis("fault", _POINTS, quick, scale="linear", names=MUTANTS),
        truth="judge of the sound scene; point 0 has no fault",
        bar=0.009,
        measure=_noticed(power),
        methods=("gauss", "field", "reference"),
        must_notice=True,
        note="Faults must be above the bar.",
    )
    for name, light, power, quick in (
        ("mutants", "windows of 50 W", 50.0, _POINTS),
        ("mutants-dark", "windows of 0.05 W", 0.05, (0, 4)),
    )
)
