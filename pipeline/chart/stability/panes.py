# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Rays past a pane of 1 m and onto it: a centimetre away, grazing, and where it becomes a point."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.stability.lab import Shot
from nightcity.chart.stability.methods import Model
from nightcity.chart.stability.sweep import Axis, Failure, Sweep, against
from nightcity.chart.stability.tiny_scene import TinyScene

FloatArray = NDArray[np.float64]

_PANE, _LAMBERTIAN = Model(emitter="pane"), Model(emitter="lambertian")
_JUDGED = 1e-4  # the judge is slow beside panes


def _pane() -> TinyScene:
    scene = TinyScene()
    scene.window((0, 0, 0), normal=(0, 1, 0), side=1.0)
    scene.haze((-160, -2, -160), (160, 160, 160), 0.01)
    return scene


def _past(model: Model):
    def shot(points: FloatArray) -> Shot:
        scene = _pane()
        for distance in points:
            scene.look((-100, distance, 0.125), (1, 0, 0))
        return Shot(scene, model, judged=_JUDGED)

    return shot


def _onto(points: FloatArray) -> Shot:
    scene = _pane()
    for angle in points:
        direction = np.array([np.cos(angle), -np.sin(angle), 0.0])
        scene.look(np.array([0.1, 0.0, 0.125]) - 20 * direction, direction)
    return Shot(scene, _PANE, judged=_JUDGED)


def _across(points: FloatArray) -> Shot:
    """Rays that leave the plane of the pane 1 cm before it."""
    scene = _pane()
    for angle in points:
        direction = np.array([np.cos(angle), np.sin(angle), 0.0])
        scene.look((0.0, 0.01, 0.125), direction)
    return Shot(scene, _PANE, judged=_JUDGED)


_DISTANCES = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 4, 7.9, 7.99, 8, 8.01, 8.1, 16, 32, 64, 128)
_ANGLES = (1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 1.0, 1.5)
_POINTS = "isotropic points instead of panes"

SWEEPS = (
    Sweep(
        name="pane-distance",
        title="A ray along a pane of 1 m",
        axis=Axis("distance of the ray to the pane, m", _DISTANCES, (0.01, 1, 7.99, 8.01)),
        truth="judge",
        bar=0.01,
        measure=against(_past(_PANE)),
        failures={
            "march": Failure(_POINTS, 0.5, 20),
            "field": Failure("nodes are metres apart 100 m from the eye", 0.01, 0.2),
        },
    ),
    Sweep(
        name="lambertian-distance",
        title="A ray past a Lambertian point",
        axis=Axis("distance of the ray to the light, m", _DISTANCES, (0.01, 0.1, 1, 8, 128)),
        truth="judge",
        bar=0.01,
        measure=against(_past(_LAMBERTIAN)),
        failures={"march": Failure("isotropic points instead of lobes", 0.5, 50)},
    ),
    Sweep(
        name="pane-onto",
        title="A ray that ends on a pane of 1 m",
        axis=Axis("angle between ray and pane, rad", _ANGLES, (0.01, 1.5)),
        truth="judge",
        bar=0.01,
        measure=against(_onto),
        failures={"march": Failure(_POINTS, 0.3, 50)},
    ),
    Sweep(
        name="pane-away",
        title="A ray from 1 cm before a pane of 1 m",
        axis=Axis("angle between ray and pane, rad", _ANGLES, (0.01, 1.5)),
        truth="judge",
        bar=0.01,
        measure=against(_across),
        failures={"march": Failure(_POINTS, 0.3, 50)},
    ),
)
