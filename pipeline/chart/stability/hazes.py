# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Thin, thick and cut haze about one light; a haze a point, 64 m above the one before."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.stability.closed_forms import airlight, scattering_per_watt
from nightcity.chart.stability.lab import Shot
from nightcity.chart.stability.sweep import Axis, Failure, Sweep, against
from nightcity.chart.stability.tiny_scene import TinyScene

FloatArray = NDArray[np.float64]

_POWER = 50.0  # W
_ALBEDO = 0.9
_APART = 64.0  # m
_BESIDE = 0.5  # m, from ray to light
_LENGTH = 20.0  # m of haze on a ray
_INTO = 2.0  # m, from its face to the light
_FORWARD = (1, 0, 0)


def _extinctions(points: FloatArray) -> Shot:
    scene = TinyScene()
    for row, extinction in enumerate(points):
        z = _APART * row
        light = scene.window((0, 0, z), power=_POWER)
        scene.haze((-_INTO, -8, z - 8), (_LENGTH - _INTO, 8, z + 8), extinction, _ALBEDO, [light])
        scene.look((-10, _BESIDE, z), _FORWARD, lit=[light])
    return Shot(scene)


def _extinctions_truth(points: FloatArray) -> FloatArray:
    return _through(points, _BESIDE)


def _through(extinctions: FloatArray, beside: float) -> FloatArray:
    truth = []
    for tau in extinctions:
        integral = airlight(float(np.float32(tau)), beside, -_INTO, _LENGTH - _INTO)
        truth.append(_POWER * scattering_per_watt(tau, _ALBEDO) * integral)
    return np.array(truth)


def _optical_lengths(points: FloatArray) -> Shot:
    scene = TinyScene()
    for row, length in enumerate(points):
        z = _APART * row
        light = scene.window((0, 0, z), power=_POWER)
        lo, hi = (-_INTO, -8, z - 8), (_LENGTH - _INTO, 8, z + 8)
        scene.haze(lo, hi, length / _LENGTH, _ALBEDO, [light])
        scene.look((-10, 0.25, z), _FORWARD, lit=[light])
    return Shot(scene)


def _optical_lengths_truth(points: FloatArray) -> FloatArray:
    return _through(points / _LENGTH, 0.25)


_TAU = 0.03


def _slices(points: FloatArray) -> Shot:
    scene = TinyScene()
    for row, count in enumerate(points):
        z = _APART * row
        light = scene.window((0, 0, z), power=_POWER)
        ends = np.linspace(-16, 16, int(count) + 1)
        for begin, end in itertools.pairwise(ends):
            scene.haze((begin, -8, z - 8), (end, 8, z + 8), _TAU, _ALBEDO, [light])
        scene.look((-18, _BESIDE, z), _FORWARD, lit=[light])
    return Shot(scene)


def _slices_truth(points: FloatArray) -> FloatArray:
    whole = airlight(float(np.float32(_TAU)), _BESIDE, -16, 16)
    return np.full(len(points), _POWER * scattering_per_watt(_TAU, _ALBEDO) * whole)


# Where the haze is cut, in x, y and z: along the faces of walls and at a light.
_CUTS = {
    1: ((), (), ()),
    8: ((0,), (-5,), (6,)),
    27: ((-5, 5), (-5, 3), (6, 20)),
    65: ((-5, 0, 3, 5), (-20, -12, -8, -5, -4, -2, 0, 1, 3, 5, 12, 20), ()),
}
_RAYS = (
    ((-40, -20, 30), (1, 0.6, -0.7)),
    ((-3, -30, 3), (0.08, 1, 0.05)),
    ((30, -26, 9), (-1, 0.9, 0.02)),
    ((1, 1, 50), (0.01, 0.05, -1)),
)


def _cut(points: FloatArray) -> Shot:
    """Two walls and two lights in haze that is cut along the walls' faces; 128 m apart."""
    scene = TinyScene()
    for row, count in enumerate(points):
        x = 128.0 * row
        scene.wall((x - 5, -12, 0), (x, -5, 20))
        scene.wall((x + 3, -4, 0), (x + 5, 12, 14))
        lights = [
            scene.window((x - 2, -4.75, 6), power=_POWER),
            scene.window((x + 2.75, 4, 9), normal=(-1, 0, 0), power=_POWER),
        ]
        _cut_haze(scene, x, _CUTS[int(count)], lights)
        for (px, py, pz), direction in _RAYS:
            scene.look((x + px, py, pz), direction, lit=lights)
    return Shot(scene)


def _cut_haze(
    scene: TinyScene, x: float, cuts: tuple[tuple[float, ...], ...], lights: list[int]
) -> None:
    ends = [[-32, *cuts[0], 32], [-32, *cuts[1], 32], [0, *cuts[2], 24]]
    for x0, x1 in itertools.pairwise(ends[0]):
        for y0, y1 in itertools.pairwise(ends[1]):
            for z0, z1 in itertools.pairwise(ends[2]):
                scene.haze((x + x0, y0, z0), (x + x1, y1, z1), _TAU, _ALBEDO, lights)


SWEEPS = (
    Sweep(
        name="extinction",
        title="Haze from none to thick",
        axis=Axis(
            "extinction, 1/m",
            (0, 1e-12, 1e-9, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.03, 0.1, 0.3, 1, 3, 10),
            (0, 1e-12, 1e-6, 1e-2, 1, 10),
            scale="symlog",
        ),
        truth="integral over the ray; glow / sigma_s is continuous down to 0",
        bar=0.01,
        measure=against(_extinctions, _extinctions_truth),
        failures={"march": Failure("steps of 0.8 m, 0.5 m beside a light", 0.02, 0.5)},
    ),
    Sweep(
        name="optical-length",
        title="A light just inside 20 m of ever thicker haze",
        axis=Axis(
            "optical length of the ray",
            (0.01, 0.1, 0.3, 1, 3, 10, 20, 30, 50, 100, 150, 200),
            (0.1, 3, 30, 200),
        ),
        truth="integral over the ray",
        bar=0.01,
        measure=against(_optical_lengths, _optical_lengths_truth),
        failures={"march": Failure("steps of 0.8 m, 0.25 m beside a light", 0.2, 1)},
    ),
    Sweep(
        name="slices",
        title="One haze cut across the ray",
        axis=Axis("boxes along the ray", (1, 2, 5, 10, 30, 100, 300, 1000), (1, 10, 1000)),
        truth="integral over the whole",
        bar=1e-3,
        measure=against(_slices, _slices_truth),
        most={"path": 30},
        note="Asked of path up to 30 boxes: its time grows with their square.",
        failures={"march": Failure("steps follow the boxes: finer cut, finer steps", 0.1, 1)},
    ),
    Sweep(
        name="cut-haze",
        title="Haze in many boxes, coplanar with walls and with each other",
        axis=Axis("boxes of haze", (1, 8, 27, 65), (1, 65)),
        truth="judge of the whole haze",
        bar=1e-3,
        measure=against(_cut),
        failures={
            "march": Failure("no visibility; steps follow the boxes", 50, 500),
            "field": Failure(
                "dark rays beside a shadow's edge, which 0.5 m between nodes blur", 0.3, 3
            ),
        },
    ),
)
