# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""One isotropic light and one ray: how near, how far, how deep, behind the eye."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.stability.closed_forms import (
    airlight,
    clear_airlight,
    lattice_error,
    scattering_per_watt,
)
from nightcity.chart.stability.lab import Lab, Shot
from nightcity.chart.stability.methods import Method
from nightcity.chart.stability.sweep import (
    FIELD_TOLERANCE,
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

_POWER = 50.0  # W
_TAU, _ALBEDO = 0.01, 0.9
_TAU32 = float(np.float32(_TAU))
_CLEAR = 1e-6  # 1/m: dims by less than 1e-4 in 100 m
_FORWARD = (1, 0, 0)


def _known(extinction: float, integrals: list[float]) -> FloatArray:
    return _POWER * scattering_per_watt(extinction, _ALBEDO) * np.array(integrals)


def _beside_a_light(points: FloatArray) -> Shot:
    """Rays along x that pass a light in the middle of 32 m of haze, the eye outside."""
    scene = TinyScene()
    scene.window((0, 0, 0), power=_POWER)
    scene.haze((-16, -16, -16), (16, 16, 16), _TAU, _ALBEDO)
    for distance in points:
        scene.look((-20, distance, 0), _FORWARD)
    return Shot(scene)


def _beside_a_light_truth(points: FloatArray) -> FloatArray:
    rounded = points.astype(np.float32).astype(float)
    return _known(_TAU, [airlight(_TAU32, h, -16, 16) for h in rounded])


_RING_BOX = 50.0  # m, half
_RING_STEP = 4.0  # m: 25 steps


def _rings(staggered: bool):
    def shot(points: FloatArray) -> Shot:
        scene = TinyScene()
        shift = 0.5 * _RING_STEP if staggered else 0.0
        scene.window((shift, 0, 0), power=_POWER)
        scene.haze((-_RING_BOX, -32, -32), (_RING_BOX, 32, 32), _CLEAR, _ALBEDO)
        for steps in points:
            scene.look((-_RING_BOX - 1, _RING_STEP * steps, 0), _FORWARD)
        return Shot(scene)

    def predicted(points: FloatArray) -> FloatArray:
        shift = 0.5 * _RING_STEP if staggered else 0.0
        distance = _RING_STEP * points
        ends = -_RING_BOX - shift, _RING_BOX - shift
        finite = np.array([clear_airlight(h, *ends) for h in distance])
        return lattice_error(points, staggered) * np.pi / distance / finite

    return shot, predicted


_STEP_DISTANCES = np.array([0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 4.0])


def _steps(lab: Lab, method: Method, points: FloatArray) -> Errors:
    """The worst of seven rays; only the march has steps, the others stand still."""
    shot = lab.shot(_beside_a_light, _STEP_DISTANCES)
    truth = _beside_a_light_truth(_STEP_DISTANCES)
    if method.name != "march":
        once = relative_errors(lab.render(shot, method).by_point(1), truth)
        return joined([once] * len(points))
    errors = []
    for steps in points:
        stepped = method.with_option("--subdivisions", steps)
        errors.append(relative_errors(lab.render(shot, stepped).by_point(1), truth))
    return joined(errors)


def _far_along(points: FloatArray) -> Shot:
    """An oblique ray 0.1 m beside a light, the eye ever farther away."""
    scene = TinyScene()
    scene.window((0, 0, 0), side=1e-3, power=_POWER)
    scene.haze((-16, -16, -16), (16, 16, 16), _TAU, _ALBEDO)
    direction = np.array([0.8, 0.36, 0.48])
    beside = 0.1 * np.array([0.0, 0.8, -0.6])
    for distance in points:
        scene.look(beside - distance * direction, direction)
    return Shot(scene)


def _thin_slab(points: FloatArray) -> Shot:
    """One metre of haze in line with a light, ever farther from it; a row each, 16 m apart."""
    scene = TinyScene()
    scene.window((0, 0, 0), power=_POWER)
    for row, distance in enumerate(points):
        y = 16.0 * row
        scene.haze((distance, y, -4), (distance + 1, y + 4, 4), _TAU, _ALBEDO)
        scene.look((distance - 4, y + 2, 0.5), _FORWARD)
    return Shot(scene)


_DENSE = 1.0  # 1/m


def _light_behind(points: FloatArray) -> Shot:
    scene = TinyScene()
    scene.window((0, 0, 0), power=_POWER)
    scene.haze((-8, -8, -8), (240, 8, 8), _DENSE, _ALBEDO)
    for depth in points:
        scene.look((depth / _DENSE, 0.25, 0), _FORWARD)
    return Shot(scene)


def _light_behind_truth(points: FloatArray) -> FloatArray:
    return _known(_DENSE, [airlight(_DENSE, 0.25, float(np.float32(x)), 240) for x in points])


_HALO = 0.25  # m beside the light


def _depths(points: FloatArray) -> Shot:
    scene = TinyScene()
    scene.haze((0, -16, -16), (32, 16, 16), _TAU, _ALBEDO, range(len(points)))
    for depth in points:
        light = scene.window((depth, 0, 0), power=_POWER)
        scene.look((-30, _HALO, 0), _FORWARD, lit=[light])
    return Shot(scene)


def _depths_truth(points: FloatArray) -> FloatArray:
    rounded = points.astype(np.float32).astype(float)
    return _known(_TAU, [airlight(_TAU32, _HALO, -x, 32 - x) for x in rounded])


def _sizes(points: FloatArray) -> Shot:
    """Boxes of haze of growing length, each about its own light, 64 m above the one before."""
    scene = TinyScene()
    for row, size in enumerate(points):
        z = 64.0 * row
        light = scene.window((0, 0, z), power=_POWER)
        scene.haze((-size / 2, -4, z - 4), (size / 2, 4, z + 4), _TAU, _ALBEDO, [light])
        scene.look((-size / 2 - 1, 0.5, z), _FORWARD, lit=[light])
    return Shot(scene)


def _sizes_truth(points: FloatArray) -> FloatArray:
    return _known(_TAU, [airlight(_TAU32, 0.5, -size / 2, size / 2) for size in points])


_STEPS_CAUSE = "equal steps do not resolve 1/d^2"
_ALIGNED, _ALIGNED_ERROR = _rings(staggered=False)
_STAGGERED, _STAGGERED_ERROR = _rings(staggered=True)
_RINGS = (0.0125, 0.025, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.25, 1.5)

SWEEPS = (
    Sweep(
        name="light-distance",
        title="A ray past a light",
        axis=Axis(
            "distance of the ray to the light, m",
            tuple(10.0 ** (e / 2) for e in range(-12, 1)),
            (1e-6, 1e-4, 1e-2, 0.1, 0.3, 1.0),
        ),
        truth="integral over the ray",
        bar=0.01,
        measure=against(_beside_a_light, _beside_a_light_truth),
        failures={
            "march": Failure(_STEPS_CAUSE, 3e4, 1e6),
            "gauss": Failure("places in a box are float32 from its corner, here 2 um", 0, 1),
        },
    ),
    Sweep(
        name="halo-depth",
        title="A halo behind the face of the haze, the eye outside",
        axis=Axis(
            "depth of the light behind the face, m",
            (0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0),
            (0.01, 0.1, 0.5, 2.0, 10.0),
        ),
        truth="integral over the ray",
        bar=0.01,
        measure=against(_depths, _depths_truth),
        failures={"march": Failure(_STEPS_CAUSE, 0.3, 3)},
    ),
    Sweep(
        name="march-rings-aligned",
        title="Rings of equal steps: a step right beside the light",
        axis=Axis("distance to the light in steps", _RINGS, (0.05, 0.25, 0.5, 1.0)),
        truth="integral over the ray",
        bar=0.01,
        measure=against(
            _ALIGNED,
            lambda points: _known(
                _CLEAR,
                [
                    airlight(float(np.float32(_CLEAR)), h, -_RING_BOX, _RING_BOX)
                    for h in np.float32(_RING_STEP * points).astype(float)
                ],
            ),
        ),
        failures={"march": Failure("rings: coth(pi h / D) - 1", 5, 6)},
        predicted=_ALIGNED_ERROR,
    ),
    Sweep(
        name="march-rings-staggered",
        title="Rings of equal steps: the light between two steps",
        axis=Axis("distance to the light in steps", _RINGS, (0.05, 0.25, 0.5, 1.0)),
        truth="integral over the ray",
        bar=0.01,
        measure=against(
            _STAGGERED,
            lambda points: _known(
                _CLEAR,
                [
                    airlight(float(np.float32(_CLEAR)), h, -_RING_BOX - 2, _RING_BOX - 2)
                    for h in np.float32(_RING_STEP * points).astype(float)
                ],
            ),
        ),
        failures={"march": Failure("rings: tanh(pi h / D) - 1", 0.8, 0.9)},
        predicted=_STAGGERED_ERROR,
    ),
    Sweep(
        name="march-steps",
        title="Steps in each box of haze: the worst of rays 0.05 to 4 m beside a light",
        axis=Axis("steps of the march", (1, 2, 5, 10, 25, 40, 100, 200, 400, 1000), (5, 1000)),
        truth="integral over the ray",
        bar=0.01,
        measure=_steps,
        failures={"march": Failure(_STEPS_CAUSE, 10, 60)},
    ),
    Sweep(
        name="eye-distance",
        title="A light 0.1 m beside an oblique ray, the eye far away",
        axis=Axis(
            "distance of the eye, m",
            (1, 3, 10, 30, 100, 300, 1000, 3000, 10000),
            (1, 30, 1000, 10000),
        ),
        truth="judge",
        bar=1e-3,
        measure=against(_far_along),
        failures={
            "march": Failure(_STEPS_CAUSE, 0.3, 10),
            "field": Failure(FIELD_TOLERANCE, 0.001, 0.01),
        },
    ),
    Sweep(
        name="thin-slab",
        title="One metre of haze in line with a light far away",
        axis=Axis(
            "distance of the haze, m", (3, 10, 30, 100, 300, 1000, 3000, 10000), (3, 100, 10000)
        ),
        truth="judge",
        bar=1e-3,
        measure=against(_thin_slab),
        failures={
            "march": Failure("dims the light as if the haze reached to it", 0.9, 1.1),
            "field": Failure(FIELD_TOLERANCE, 0.001, 0.02),
        },
    ),
    Sweep(
        name="light-behind",
        title="A light behind the eye",
        axis=Axis(
            "optical depths behind the eye",
            (0.1, 0.3, 1, 3, 10, 20, 40, 60, 80, 120, 160, 200),
            (0.1, 1, 10, 60, 200),
        ),
        truth="integral over the ray",
        bar=0.01,
        measure=against(_light_behind, _light_behind_truth, floor=1e-30),
        note="Below 1e-30 W m^-2 sr^-1 an error is absolute: float32 ends there.",
        failures={"march": Failure("steps of 9 m in haze of 1 m mean free path", 0.9, 1.1)},
    ),
    Sweep(
        name="box-size",
        title="A halo in a growing box of haze",
        axis=Axis("length of the box, m", (4, 8, 16, 32, 64, 100, 200, 400), (4, 32, 400)),
        truth="integral over the ray",
        bar=0.01,
        measure=against(_sizes, _sizes_truth),
        failures={"march": Failure("steps grow with the box", 2, 12)},
    ),
)
