# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The eye: far from the origin, high up, grazing the haze, moving by millimetres; the image's size.

A street of two walls and three lights.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.stability.lab import Glow, Lab, Shot
from nightcity.chart.stability.methods import Method
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

_TAU = 0.03125
_CAUSE = "no visibility; equal steps"
_UNEVEN = 1.0137  # of lengths: float32 rounds the places of a street in different directions


def street(shift: FloatArray | float = 0.0, power: float = 50.0, scale: float = 1.0) -> TinyScene:
    """The street without a view. shift: m, (3,); scale: of all lengths, extinction divided."""

    def at(x: float, y: float, z: float) -> FloatArray:
        return scale * np.array([x, y, z]) + shift

    scene = TinyScene()
    scene.wall(at(-10, -20, 0), at(-5, 20, 20))
    scene.wall(at(5, -12, 0), at(10, 12, 16))
    watts = power * scale**2
    for centre, normal in (
        ((-4.75, -8, 5), (1, 0, 0)),
        ((-4.75, 6, 9), (1, 0, 0)),
        ((4.75, -3, 7), (-1, 0, 0)),
    ):
        scene.window(at(*centre), normal=normal, side=scale, power=watts)
    scene.haze(at(-32, -32, 0), at(32, 32, 24), _TAU / scale)
    return scene


# Position and direction of rays that see haze: down the street, across it, from above, outside.
_RAYS = (
    ((0, -60, 20), (1, 90, -17)),
    ((2, -18, 2), (-1, 43, 12)),
    ((-4, -1, 9), (7, 1, 0)),
    ((40, -40, 30), (-40, 40, -26)),
)


def look_around(scene: TinyScene, shift: FloatArray | float = 0.0, scale: float = 1.0) -> None:
    """A frame for each of the rays."""
    for position, direction in _RAYS:
        scene.look(scale * np.array(position, float) + shift, direction)


def _moved_shot(points: FloatArray) -> Shot:
    shift = np.array([1.00012345, -0.77703217, 0.0]) * points[0]
    scene = street(shift, scale=_UNEVEN)
    look_around(scene, shift, scale=_UNEVEN)
    return Shot(scene)


def _moved(lab: Lab, method: Method, points: FloatArray) -> Errors:
    """Against the judge of the same rounded places: what is lost besides by being far away."""
    errors = []
    for distance in points:
        shot = lab.shot(_moved_shot, np.array([distance]))
        truth = lab.judge(shot).by_point(1).value
        errors.append(relative_errors(lab.render(shot, method).by_point(1), truth))
    return joined(errors)


def _heights(points: FloatArray) -> Shot:
    scene = street()
    for height in points:
        position = np.array([0.0, -40.0, height])
        scene.look(position, np.array([1.0, 0.0, 6.0]) - position)
    return Shot(scene)


def _grazing(points: FloatArray) -> Shot:
    """Rays down the street that enter or leave the top of the haze at ever smaller angles, in the
    middle of the street."""
    scene = street()
    for angle in points:
        for side in (-1, 1):
            direction = np.array([0.0, np.cos(angle), side * np.sin(angle)])
            scene.look(np.array([1.0, 0.0, 24.0]) - 60 * direction, direction)
    return Shot(scene)


_DOLLY = 1e-3  # m a frame
_DOLLY_VIEWS = (
    ((0.5, -18.0, 2.0), (-1, 43, 12)),
    ((0.0, -60.0, 20.0), (1, 90, -17)),
    ((-4.45, -18.0, 5.05), (0.01, 1, 0.002)),  # 0.3 m past a light
)


def _dolly_shot(points: FloatArray) -> Shot:
    """One view after the other; the eye moves sideways."""
    scene = street()
    for position, direction in _DOLLY_VIEWS:
        for frame in points:
            scene.look(np.array(position) + (_DOLLY * frame, 0, 0), direction)
    return Shot(scene)


def _second_differences(glow: Glow) -> Glow:
    """Of each view along its frames, relative to its mean glow: (frames - 2, views)."""
    value = glow.value.reshape(len(_DOLLY_VIEWS), -1).T
    noise = glow.noise.reshape(len(_DOLLY_VIEWS), -1).T
    second = value[2:] - 2 * value[1:-1] + value[:-2]
    spread = np.sqrt(noise[2:] ** 2 + 4 * noise[1:-1] ** 2 + noise[:-2] ** 2)
    mean = value.mean(axis=0)
    return Glow(second / mean, spread / mean)


def _dolly(lab: Lab, method: Method, points: FloatArray) -> Errors:
    """What the second difference has beyond the judge's; 0 at both ends."""
    shot = lab.shot(_dolly_shot, points)
    found = _second_differences(lab.render(shot, method))
    truth = _second_differences(lab.judge(shot)).value
    inner = relative_errors(found, truth, np.ones_like(truth))
    return Errors(np.pad(inner.error, 1), np.pad(inner.noise, 1))


def _size_shot(points: FloatArray) -> Shot:
    """The nine rays of a 3 x 3 image, in an image of 3^k x 3^k."""
    side = int(points[0])
    scene = street()
    scene.look((0, -60, 20), (1, 90, -17), tangent=0.1)
    step = side // 3
    pixels = tuple((step * x + step // 2, step * y + step // 2) for y in range(3) for x in range(3))
    return Shot(scene, size=(side, side), pixels=pixels)


def _sizes(lab: Lab, method: Method, points: FloatArray) -> Errors:
    truth = lab.judge(lab.shot(_size_shot, np.array([3.0]))).value
    errors = []
    for side in points:
        found = lab.render(lab.shot(_size_shot, np.array([side])), method)
        errors.append(relative_errors(found, truth))
    return joined(errors)


SWEEPS = (
    Sweep(
        name="moved-scene",
        title="The scene far from the origin of its own coordinates",
        axis=Axis(
            "distance from the origin, m",
            (0, 1, 10, 100, 1000, 5000, 10000, 20000, 50000, 100000),
            (100000,),
            scale="symlog",
        ),
        truth="judge",
        bar=1e-3,
        measure=_moved,
        note="Float32 holds places to 4 mm at 100 km, alike for the judge: that alone changes this "
        "glow by 0.12 %. The exporter keeps coordinates small.",
        failures={"march": Failure(_CAUSE, 0.2, 20)},
    ),
    Sweep(
        name="eye-height",
        title="The eye ever higher, looking down on a street",
        axis=Axis(
            "height of the eye, m",
            (0.01, 0.1, 1, 3, 10, 20, 23.99, 24, 24.01, 30, 100, 1000, 10000),
            (0.01, 3, 24, 1000),
        ),
        truth="judge",
        bar=0.01,
        measure=against(_heights),
    ),
    Sweep(
        name="grazing-haze",
        title="Rays through the top face of the haze",
        axis=Axis(
            "angle between ray and face, rad",
            (1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3, 1.0, 1.5),
            (1e-5, 1e-3, 0.1, 1.5),
        ),
        truth="judge",
        bar=0.01,
        measure=against(_grazing),
    ),
    Sweep(
        name="dolly",
        title="The eye moves sideways, 1 mm a frame",
        axis=Axis("frame", tuple(range(200)), tuple(range(24)), scale="linear"),
        truth="second differences of the judge; errors relate to the glow",
        bar=1e-4,
        measure=_dolly,
    ),
    Sweep(
        name="image-size",
        title="The same rays in larger images",
        axis=Axis("pixels a side", (3, 9, 27, 81, 243, 729, 2187, 6561), (6561,)),
        truth="judge of the smallest image",
        bar=0.01,
        measure=_sizes,
    ),
)
