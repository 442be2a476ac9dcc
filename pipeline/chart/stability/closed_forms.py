# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Glow that is known: integrals over a ray, lattices of samples, planes of lights, diffusion.

Everything in double precision; lengths in m, extinction in 1/m, power in W.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)
_PIECES = 400


def airlight(
    extinction: float, distance: float, begin: float, end: float, before: float = 0.0
) -> float:
    """Integral of exp(-extinction (before + s + d)) / d^2, 1/m, over a ray in one haze.

    The ray passes a point ``distance`` beside it; the integral runs from ``begin`` to ``end``
    relative to the foot of the perpendicular, s counts from ``begin``, d is the distance to the
    point. Composite Gauss-Legendre quadrature in the angle at the point, to about 1e-13.
    """
    angles = np.linspace(np.arctan(begin / distance), np.arctan(end / distance), _PIECES + 1)
    half = 0.5 * np.diff(angles)[:, None]
    angle = angles[:-1, None] + half * (1 + _NODES)
    along = distance * np.tan(angle)
    depth = extinction * (before + along - begin + distance / np.cos(angle))
    return float((half * _WEIGHTS * np.exp(-depth)).sum() / distance)


def clear_airlight(distance: float, begin: float, end: float) -> float:
    """The same without extinction: the angle that the segment spans, over the distance."""
    return float(np.arctan2(distance * (end - begin), distance**2 + begin * end) / distance)


def inverse_square(begin: float, end: float) -> float:
    """The same on a ray straight away from the point, begin > 0."""
    return (end - begin) / (begin * end)


def lattice_error(distance_in_steps: FloatArray, staggered: bool) -> FloatArray:
    """Relative error of equal steps past a point light in clear air, without ends.

    The sum over all k of D / (h^2 + (k D)^2) is pi / h coth(pi h / D), and with the lattice
    staggered by half a step pi / h tanh(pi h / D); the integral is pi / h.
    """
    tanh = np.tanh(np.pi * distance_in_steps)
    return tanh - 1 if staggered else 1 / tanh - 1


def exponential_integral(x: float) -> float:
    """E1(x), x > 0: the integral of exp(-x / mu) / mu over mu from 0 to 1, to about 1e-13."""
    # With mu = 1 / (1 + u): exp(-x) times the integral of exp(-x u) / (1 + u), cut at 60 / x.
    ends = np.concatenate([[0.0], np.geomspace(1e-6, 60.0, 200)]) / x
    half = 0.5 * np.diff(ends)[:, None]
    u = ends[:-1, None] + half * (1 + _NODES)
    return float(np.exp(-x) * (half * _WEIGHTS * np.exp(-x * u) / (1 + u)).sum())


def grosjean(albedo: float, depth: FloatArray) -> FloatArray:
    """Fluence of all orders over unscattered fluence, ``depth`` mean free paths from a point.

    Grosjean's diffusion (1956) in infinite haze with an isotropic phase function:
    phi = P (exp(-tau r) / (4 pi r^2) + a exp(-k r) / (4 pi D r)), D = (2 sigma_a + sigma_s) /
    (3 tau^2), k = sqrt(sigma_a / D). Within about 5.5 % of the truth.
    """
    diffusion = (2 * (1 - albedo) + albedo) / 3
    decay = np.sqrt((1 - albedo) / diffusion)
    return 1 + albedo * depth / diffusion * np.exp(depth * (1 - decay))


def scattering_per_watt(extinction: float, albedo: float) -> float:
    """Glow of an isotropic light of one watt over its airlight integral: tau a / (4 pi)^2."""
    return float(np.float32(extinction)) * float(np.float32(albedo)) / (4 * np.pi) ** 2
