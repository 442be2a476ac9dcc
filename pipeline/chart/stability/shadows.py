# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Walls: light that must not pass them, and shadow edges that must lie where they are."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.stability.closed_forms import scattering_per_watt
from nightcity.chart.stability.lab import Lab, Shot
from nightcity.chart.stability.methods import PLAIN, Method, Model
from nightcity.chart.stability.sweep import (
    Axis,
    Errors,
    Failure,
    Sweep,
    against,
    relative_errors,
)
from nightcity.chart.stability.tiny_scene import TinyScene

FloatArray = NDArray[np.float64]

_POWER = 50.0  # W
_NO_VISIBILITY = "no visibility"


def _courtyards(model: Model):
    def shot(points: FloatArray) -> Shot:
        """A courtyard of 10 x 10 m within haze as high as its walls, one every 256 m."""
        scene = TinyScene()
        scene.ground = 0.0
        for row, height in enumerate(points):
            x = 256.0 * row
            for lo, hi in (((-6, -6), (-5, 6)), ((5, -6), (6, 6)), ((-5, -6), (5, -5)),
                           ((-5, 5), (5, 6))):  # fmt: skip
                scene.wall((x + lo[0], lo[1], 0), (x + hi[0], hi[1], height))
            lights = [
                scene.window((x, 4.5, height / 4), normal=(0, -1, 0), power=_POWER),
                scene.window((x + 1, -4.5, height / 2), power=_POWER),
            ]
            scene.haze((x - 40, -40, 0), (x + 40, 40, height), 0.01, lights=lights)
            scene.look((x - 50, -8, height / 2), (1, 0, 0), lit=lights)
            scene.look((x - 8, -50, height / 8), (0, 1, 0), lit=lights)
            scene.look((x + 30, 30, 3 * height), (-9, -10, -3 * height), lit=lights)
        return Shot(scene, model)

    return shot


_WALLED, _OPEN = _courtyards(PLAIN), _courtyards(Model(visibility="none"))


def _leak(lab: Lab, method: Method, points: FloatArray) -> Errors:
    """Glow outside the courtyards, where there must be none, as a share of that without walls."""
    found = lab.render(lab.shot(_WALLED, points), method).by_point(len(points))
    unhidden = lab.judge(lab.shot(_OPEN, points)).by_point(len(points)).value
    return relative_errors(found, np.zeros_like(unhidden), unhidden)


_CLEAR = 1e-9  # 1/m: dims by less than 1e-7
_HALF = 16.0  # m: the ray runs from -16 to 16, 4 m from the light
_RAY = 4.0  # m


def _posts(points: FloatArray) -> Shot:
    """A wall between light and ray, 1 m from the light, ever wider: its shadow on the ray is four
    times as wide. One each 64 m. The window faces the wall: about its plane, 5 cm are its own."""
    scene = TinyScene()
    for row, half in enumerate(points):
        z = 64.0 * row
        light = scene.window((0, 0, z), normal=(1, 0, 0), side=1e-3, power=_POWER)
        scene.wall((1, -half, z - 8), (2, half, z + 8))
        scene.haze((-8, -_HALF, z - 16), (8, _HALF, z + 16), _CLEAR, lights=[light])
        scene.look((_RAY, -20, z), (0, 1, 0), lit=[light])
    return Shot(scene)


def _posts_truth(points: FloatArray) -> FloatArray:
    half = np.float32(points).astype(float)
    lit = 2 * (np.arctan(_HALF / _RAY) - np.arctan(half)) / _RAY
    return _POWER * scattering_per_watt(_CLEAR, 0.9) * lit


SWEEPS = (
    Sweep(
        name="courtyard",
        title="Lights behind the walls of a courtyard, seen from outside",
        axis=Axis("height of the walls, m", (2, 5, 10, 20, 40, 80), (5, 40)),
        truth="exactly 0; errors are shares of the glow without walls",
        bar=0.0,
        measure=_leak,
        failures={"march": Failure(_NO_VISIBILITY, 0.5, 20)},
    ),
    Sweep(
        name="shadow-edge",
        title="The shadow of a wall on a ray",
        axis=Axis(
            "half width of the wall, m",
            (1e-3, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 2, 3, 3.9, 3.99, 3.999),
            (1e-3, 0.1, 1, 3.99),
        ),
        truth="angle that the lit rest of the ray spans",
        bar=0.01,
        measure=against(_posts, _posts_truth),
        most={"path": 3.0},
        note="Asked of path up to 3 m: few of its paths meet what is lit beyond.",
        failures={"march": Failure(_NO_VISIBILITY, 1e3, 5e3)},
    ),
)
