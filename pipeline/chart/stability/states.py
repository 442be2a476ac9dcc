# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""What must not matter: switching, seeds, numbers of samples, units of power and length."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from nightcity.chart.stability.lab import Glow, Lab, Shot
from nightcity.chart.stability.methods import Method, Model
from nightcity.chart.stability.sweep import (
    Axis,
    Errors,
    Failure,
    Sweep,
    joined,
    relative_errors,
)
from nightcity.chart.stability.tiny_scene import TinyScene
from nightcity.chart.stability.views import look_around, street

FloatArray = NDArray[np.float64]

_LIT = ((0, 1, 2), (0, 2), (1,), (), (0, 1, 2), (2,), (0, 1), (0, 1, 2))


def _switched_shot(points: FloatArray) -> Shot:
    scene = street()
    for frame in points:
        scene.look((0, -60, 20), (1, 90, -17), lit=_LIT[int(frame) % len(_LIT)])
    return Shot(scene)


def _switched(lab: Lab, method: Method, points: FloatArray) -> Errors:
    """Each frame of a shot against the same frame from a process of its own, to the bit."""
    shot = lab.shot(_switched_shot, points)
    together = lab.render(shot, method)
    errors = []
    for index in range(len(points)):
        alone = lab.render(shot, method, frames=[index + 1]).value
        bits = Glow(together.value[index : index + 1], np.zeros_like(alone))
        errors.append(relative_errors(bits, alone, np.maximum(alone, 1e-9)))
    return joined(errors)


_BAD_VALUES = (np.nan, np.inf, -1.0)
# Array and field, and how an error names them.
_BAD_FIELDS = (("window", "power"), ("window", "centre"), ("window", "colour"),
               ("media_box", "extinction"), ("media_box", "albedo"),
               ("camera_frame", "position"))  # fmt: skip

_BAD = tuple(range(len(_BAD_FIELDS) * len(_BAD_VALUES)))
_BAD_NAMES = tuple(f"{array}.{name} {bad:g}" for array, name in _BAD_FIELDS for bad in _BAD_VALUES)


def _spoil(arrays: dict[str, NDArray], place: tuple[str, str], value: float) -> None:
    array, name = place
    field = arrays[array][name][-1:]
    field.reshape(-1)[0] = value


def _refusals(lab: Lab, method: Method, points: FloatArray) -> Errors:
    """1 where a bad number is not refused by name, or a good scene after it is not as before."""
    good = lab.shot(_switched_shot, np.arange(1.0))
    before = lab.render(good, method).value
    missed = []
    for number in points.astype(int):
        place, value = _BAD_FIELDS[number // 3], _BAD_VALUES[number % 3]
        scene = street()
        look_around(scene)
        scene.spoil = lambda arrays, at=place, bad=value: _spoil(arrays, at, bad)
        legal = value == -1.0 and place[1] in ("centre", "position")
        refusal = lab.refusal(Shot(scene), method)
        named = re.search(rf"exit code 3: .*{place[0]}\[\d+\]\.{place[1]}", refusal or "")
        missed.append(float((refusal is not None) if legal else named is None))
    clean = np.array_equal(before, lab.render(good, method).value)
    return Errors(np.maximum(missed, float(not clean)), np.zeros(len(missed)))


def _all_around(points: FloatArray) -> Shot:
    """Lights about a ray, some within the bounds of the others, some centimetres from it."""
    scene = TinyScene()
    for centre in ((0, 0.02, 0), (1, 0.5, 0.3), (-2, -1.5, 1), (3, 4, -3), (0.5, -0.1, 0.1)):
        scene.window(centre, normal=(0, 0, 1), side=1e-3, power=50)
    scene.haze((-8, -8, -8), (8, 8, 8), 0.05)
    scene.look((-10, 0, 0), (1, 0, 0))
    return Shot(scene, Model(visibility="none"))


def _seeds(lab: Lab, method: Method, points: FloatArray) -> Errors:
    """What has no noise knows no seed either: the option changes nothing."""
    shot = lab.shot(_all_around, np.zeros(1))
    truth = lab.judge(shot).value
    found = [lab.render(shot, method, options=["--seed", f"{seed:g}"]) for seed in points]
    return joined([relative_errors(glow, truth) for glow in found])


def _samples(lab: Lab, method: Method, points: FloatArray) -> Errors:
    shot = lab.shot(_all_around, np.zeros(1))
    truth = lab.judge(shot).value
    found = [lab.render(shot, method.with_option("--samples", count)) for count in points]
    return joined([relative_errors(glow, truth) for glow in found])


def _powers(points: FloatArray) -> Shot:
    scene = street(power=50.0 * float(points[0]))
    look_around(scene)
    return Shot(scene)


def _power(lab: Lab, method: Method, points: FloatArray) -> Errors:
    truth = lab.judge(lab.shot(_powers, np.ones(1))).by_point(1).value
    errors = []
    for factor in points:
        found = lab.render(lab.shot(_powers, np.array([factor])), method).by_point(1)
        errors.append(relative_errors(found, factor * truth))
    return joined(errors)


def _scales(points: FloatArray) -> Shot:
    """Lengths times s, extinction over s, power times s^2: the same radiance."""
    scene = street(scale=float(points[0]))
    look_around(scene, scale=float(points[0]))
    return Shot(scene)


def _scale(lab: Lab, method: Method, points: FloatArray) -> Errors:
    truth = lab.judge(lab.shot(_scales, np.ones(1))).by_point(1).value
    found = [lab.render(lab.shot(_scales, np.array([s])), method).by_point(1) for s in points]
    return joined([relative_errors(glow, truth) for glow in found])


_STEPS = "no visibility; equal steps"

SWEEPS = (
    Sweep(
        name="switched",
        title="Windows switched from frame to frame",
        axis=Axis("frame", tuple(range(8)), (0, 1), scale="linear"),
        truth="the same frame rendered alone, to the bit",
        bar=0.0,
        measure=_switched,
    ),
    Sweep(
        name="bad-numbers",
        title="NaN, infinite and negative numbers in a scene: 1 where one is not refused by name",
        axis=Axis("field and value", _BAD, _BAD[::4], scale="linear", names=_BAD_NAMES),
        truth="exit code 3 naming the field; the next frame of a good scene as before",
        bar=0.0,
        measure=_refusals,
        methods=("reference",),
        note="The loader is one for all methods.",
    ),
    Sweep(
        name="seeds",
        title="Seeds: five lights about a ray, some of them centimetres from it",
        axis=Axis("seed", tuple(range(24)), (3,), scale="linear"),
        truth="judge",
        bar=0.01,
        measure=_seeds,
        failures={"march": Failure(_STEPS, 0.1, 20)},
    ),
    Sweep(
        name="samples",
        title="Paths a pixel: the error falls by the square root of their number",
        axis=Axis("paths of one of 128 rays", (16, 64, 256, 1024, 4096), (64, 1024)),
        truth="judge",
        bar=0.01,
        measure=_samples,
        methods=("path",),
    ),
    Sweep(
        name="power",
        title="The same city, brighter or darker",
        axis=Axis("power, times 50 W", (1e-9, 1e-6, 1e-3, 1, 1e3, 1e6, 1e9), (1e-3,)),
        truth="judge at 50 W, times the factor",
        bar=1e-3,
        measure=_power,
        failures={"march": Failure(_STEPS, 0.2, 20)},
    ),
    Sweep(
        name="unit-scale",
        title="The same city in other units of length",
        axis=Axis("lengths, times", (1e-3, 0.01, 0.1, 1, 10, 100, 1000), (1000,)),
        truth="judge at 1",
        bar=1e-3,
        measure=_scale,
        failures={"march": Failure(_STEPS, 0.2, 20)},
    ),
)
