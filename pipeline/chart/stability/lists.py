# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What light lists of a given reach leave out, and the order of the lights."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.stability.closed_forms import exponential_integral, scattering_per_watt
from nightcity.chart.stability.lab import Lab, Shot
from nightcity.chart.stability.methods import Method, Model
from nightcity.chart.stability.sweep import (
    Axis,
    Errors,
    Failure,
    Sweep,
    against,
    joined,
    relative_errors,
)
from nightcity.chart.stability.tiny_scene import TinyScene

FloatArray = NDArray[np.float64]

_UNHIDDEN = Model(visibility="none")
_TAU, _ALBEDO = 0.2, 0.8
_SPACING, _AREA_POWER = 2.0, 0.25  # m; W/m^2
_BORDER = 25  # lights from the middle to the border: 10 optical depths
_HEIGHT = 4.0  # m of the ray above the plane of lights
_BOX = 5.0  # m, half


def _plane_of_lights(reach: float) -> TinyScene:
    """Haze of 10 x 10 x 2 m above a plane of lights; it lists those within ``reach``."""
    scene = TinyScene()
    lights = [
        scene.window(centre, normal=(0, 0, -1), side=0.5, power=_AREA_POWER * _SPACING**2)
        for centre in _lattice()
    ]
    away = np.maximum(np.abs(_lattice()) - (_BOX, _BOX, 0.0), 0.0)
    away[:, 2] = _HEIGHT - 1
    near = np.flatnonzero(np.linalg.norm(away, axis=1) <= reach)
    lo, hi = (-_BOX, -_BOX, _HEIGHT - 1), (_BOX, _BOX, _HEIGHT + 1)
    scene.haze(lo, hi, _TAU, _ALBEDO, [lights[i] for i in near])
    scene.look((-_BOX - 1, 0.3, _HEIGHT), (1, 0, 0))
    return scene


def _lattice() -> FloatArray:
    places = _SPACING * np.arange(-_BORDER, _BORDER + 1)
    x, y = np.meshgrid(places, places, indexing="ij")
    return np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)


def _furnace_truth() -> float:
    """Fluence (p / 2) E1(tau z) above a plane of p watts a square metre, over the ray. The lattice
    is the plane to exp(-2 pi z / s), here 4e-6."""
    fluence = 0.5 * _AREA_POWER * exponential_integral(_TAU * _HEIGHT)
    dimming = -np.expm1(-_TAU * 2 * _BOX) / _TAU
    return 4 * np.pi * scattering_per_watt(_TAU, _ALBEDO) * fluence * dimming


def _furnace(lab: Lab, method: Method, points: FloatArray) -> Errors:
    """Only lists have a reach: a method that takes all lights stands still."""
    reaches = points if method.paper_only else points[-1:]
    errors = []
    for reach in reaches:
        shot = lab.shot(_furnace_shot, np.array([reach]))
        errors.append(relative_errors(lab.render(shot, method).by_point(1), _furnace_truth()))
    return joined(errors * (len(points) // len(reaches)))


def _furnace_shot(points: FloatArray) -> Shot:
    return Shot(_plane_of_lights(float(points[0])), _UNHIDDEN)


def _seam(points: FloatArray) -> Shot:
    """Rays across the street at both sides of the face between two boxes; the light 9 m from the
    face is listed by the box that it touches within 10 m."""
    scene = TinyScene()
    light = scene.window((-18.5, 0, 0))
    scene.haze((-10, -5, -5), (0, 5, 5), 0.01, lights=[light])
    scene.haze((0, -5, -5), (10, 5, 5), 0.01, lights=[])
    for x in points:
        scene.look((x, -8, 1), (0, 1, 0))
    return Shot(scene, _UNHIDDEN)


def _many(points: FloatArray, shuffled: bool) -> Shot:
    """Lights of 50 W together, strewn over 200 x 200 m, in one order or another."""
    count = int(points[0])
    random = np.random.default_rng(count)
    centres = random.uniform((-100, -100, 0), (100, 100, 20), (count, 3))
    powers = 50.0 / count * random.uniform(0.1, 1.9, count)
    order = random.permutation(count) if shuffled else np.arange(count)
    scene = TinyScene()
    for i in order:
        scene.window(centres[i], side=0.01, power=powers[i])
    scene.haze((-100, -100, 0), (100, 100, 20), 0.02)
    scene.look((-120, 3, 25), (1, 0.02, -0.1))
    return Shot(scene, _UNHIDDEN)


def _order(lab: Lab, method: Method, points: FloatArray) -> Errors:
    errors = []
    for count in points:
        one, other = (lab.shot(make, np.array([count])) for make in (_sorted, _shuffled))
        first, second = (lab.render(shot, method) for shot in (one, other))
        errors.append(relative_errors(second.noisier_by(first), first.value))
    return joined(errors)


def _sorted(points: FloatArray) -> Shot:
    return _many(points, shuffled=False)


def _shuffled(points: FloatArray) -> Shot:
    return _many(points, shuffled=True)


SWEEPS = (
    Sweep(
        name="list-reach",
        title="Above a plane of lights, of which lists hold the near ones",
        axis=Axis("reach of the lists, m", (5, 7, 10, 15, 20, 30, 60), (5, 60)),
        truth="(p / 2) E1(tau z)",
        bar=0.01,
        measure=_furnace,
        failures={"march": Failure("lists leave far lights out", 0.1, 0.6)},
    ),
    Sweep(
        name="list-seam",
        title="Across a street from box to box, the light in one list only",
        axis=Axis(
            "distance past the face, m",
            (-5, -2, -0.5, -0.1, -0.01, 0.01, 0.1, 0.5, 2, 5),
            (-2, -0.01, 0.01, 2),
            scale="symlog",
        ),
        truth="judge of all lights",
        bar=0.01,
        measure=against(_seam),
        failures={"march": Failure("a seam where the list ends", 0.99, 1.01)},
    ),
    Sweep(
        name="light-order",
        title="The same lights in another order",
        axis=Axis("lights", (10, 100, 1000, 10000, 100000), (1000,)),
        truth="the same method in the first order",
        bar=1e-4,
        measure=_order,
    ),
)
