# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Multiple scattering in infinite haze about one light."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.stability.closed_forms import grosjean
from nightcity.chart.stability.lab import Lab, Shot
from nightcity.chart.stability.methods import PLAIN, Method, Model
from nightcity.chart.stability.sweep import (
    Axis,
    Errors,
    Failure,
    Sweep,
    relative_errors,
)
from nightcity.chart.stability.tiny_scene import TinyScene

FloatArray = NDArray[np.float64]

_TAU, _ALBEDO = 0.1, 0.9
_HAZE = 160.0  # m, half: eight lengths over which the diffuse fluence falls by e
_SEEN = 0.5  # m of haze that the ray sees


def _probes(points: FloatArray) -> Shot:
    """Rays that see half a metre of haze, ever more mean free paths from the light: a black plate
    of 1 cm ends each. They lie in different directions, so that no plate is in another's way."""
    scene = TinyScene()
    scene.window((0, 0, 0), side=0.01, power=50)
    scene.haze((-_HAZE,) * 3, (_HAZE,) * 3, _TAU, _ALBEDO)
    for row, depth in enumerate(points):
        turn = 2 * np.pi * row / len(points)
        place = depth / _TAU * np.array([np.cos(turn), np.sin(turn), 0.0])
        plate = place + (0, 0, 0.5 * _SEEN)
        scene.wall(plate - (0.005, 0.005, 0), plate + (0.005, 0.005, 0.01))
        scene.look(place - (0, 0, 0.5 * _SEEN), (0, 0, 1))
    return Shot(scene, Model(scattering="multiple"))


def _single(points: FloatArray) -> Shot:
    shot = _probes(points)
    return Shot(shot.scene, PLAIN)


def _fluence(lab: Lab, method: Method, points: FloatArray) -> Errors:
    """Glow against the judge's single scattering times Grosjean's ratio."""
    if method.orders:
        many = method.with_option("--samples", 4096)
        found = lab.render(lab.shot(_probes, points), many).by_point(len(points))
    else:
        found = lab.render(lab.shot(_single, points), method).by_point(len(points))
    once = lab.judge(lab.shot(_single, points)).by_point(len(points)).value
    return relative_errors(found, once * grosjean(_ALBEDO, points)[:, None])


_MISSING = Failure("single scattering: 1 - 1 / Grosjean", 0.75, 0.85)

SWEEPS = (
    Sweep(
        name="multiple-scattering",
        title="Fluence about a light in endless haze, albedo 0.9",
        axis=Axis(
            "mean free paths from the light", (0.1, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0), (0.25, 1.0)
        ),
        truth="Grosjean's formula, itself within 5.5 %",
        bar=0.055,
        measure=_fluence,
        failures=dict.fromkeys(("march", "gauss", "field", "reference"), _MISSING),
    ),
)
