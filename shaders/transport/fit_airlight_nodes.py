# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Fits the number of quadrature nodes that an air-light integral needs.

    python shaders/transport/fit_airlight_nodes.py > shaders/transport/airlight_node_fit.h

An interval is told by two optical depths: from its begin to the midpoint of the
substituted variable (first) and from there to its end (second). For random
intervals of every shape the error of each rule is measured against a composite
rule of 16 nodes, and an upper envelope is fitted: a quadratic form in the logarithms
of the depths and of the tolerance, by quantile regression (iterated weights).
tests/renderer/airlight_*_test.cpp verify what the fit promises on other cases.
"""
from __future__ import annotations

import itertools

import numpy as np

MOST_NODES = 12
SHARE = 0.8  # of the tolerance, for the quadrature; the rest is for the clipped tail
CASES = 60_000
GRADED_FROM = 8.0  # second / first depth, from where nodes are graded towards the end
THIN = 0.02  # depth below which a lobe is always integrated by its sine
TOLERANCES = 10.0 ** np.linspace(-1, -4, 13)
SHAPES = ("isotropic", "lambertian")


class Intervals:
    """Random intervals with h = 1: X = tan(a quarter turn of psi), theta = 2 psi - pi/2."""

    def __init__(self, count: int, cosine: bool, generator: np.random.Generator) -> None:
        self.cosine = cosine
        self.reach = 10 ** generator.uniform(-4, 4, count)  # X at x = 0
        end = self.reach + 10 ** generator.uniform(-4, 7, count)
        self.extinction = 10 ** generator.uniform(-2.7, 1.2, count) / (end - self.reach)
        self.begin = np.zeros(count)
        self.end = 2 * np.arctan2(end - self.reach, 1 + self.reach * end)
        # Angle of the begin from the axis of the lobe, as the ray's plane sees it.
        self.turn = generator.uniform(-np.pi, np.pi, count)
        if cosine:
            self.begin = np.maximum(0, -np.pi / 2 - self.turn)
            self.end = np.minimum(self.end, np.pi / 2 - self.turn)
        self._keep(self.end > self.begin * (1 + 1e-6) + 1e-9)
        self.depth = self.extinction * (self._reach_at(self.end) - self._reach_at(self.begin))
        self._keep((self.depth > 2e-3) & (self.depth < 14))

    def _keep(self, mask: np.ndarray) -> None:
        for name, values in vars(self).items():
            if isinstance(values, np.ndarray):
                setattr(self, name, values[mask])

    def _reach_at(self, angle: np.ndarray) -> np.ndarray:
        tangent = np.tan(angle / 2)
        return (self.reach + tangent) / (1 - self.reach * tangent)

    def _attenuation(self, angle: np.ndarray) -> np.ndarray:
        return np.exp(-self.extinction * (self._reach_at(angle) - self._reach_at(self.begin)))

    def _lobe(self, angle: np.ndarray) -> np.ndarray | float:
        return np.cos(angle + self.turn) if self.cosine else 1.0

    def _angle(self, fraction: float | np.ndarray, by_sine: bool) -> np.ndarray:
        if not by_sine:
            return self.begin + fraction * (self.end - self.begin)
        low, high = np.sin(self.begin + self.turn), np.sin(self.end + self.turn)
        sine = np.clip(low + fraction * (high - low), -1, 1)
        return np.clip(np.arcsin(sine) - self.turn, self.begin, self.end)

    def rule(self, nodes: int, graded: bool) -> np.ndarray:
        """The integral by Gauss-Legendre, as airlight*.h have it."""
        if not self.cosine:
            return self._sum(nodes, graded, by_sine=False)
        sine = self._sum(nodes, graded, by_sine=True)
        if graded or nodes <= 3:
            return sine
        return np.where(self.depth < THIN, sine, self._sum(nodes, graded, by_sine=False))

    def _sum(self, nodes: int, graded: bool, by_sine: bool) -> np.ndarray:
        if by_sine:
            span = np.sin(self.end + self.turn) - np.sin(self.begin + self.turn)
        else:
            span = self.end - self.begin
        total = np.zeros_like(span)
        for x, weight in zip(*np.polynomial.legendre.leggauss(nodes), strict=True):
            y = (1 + x) / 2
            fraction, density = (1 - y**3, 3 * y**2) if graded else (y, 1.0)
            angle = self._angle(fraction, by_sine)
            lobe = 1.0 if by_sine else self._lobe(angle)
            total += weight / 2 * density * span * lobe * self._attenuation(angle)
        return total

    def exact(self) -> np.ndarray:
        """The integral by 16 nodes on each of 17 pieces."""
        first, last = self._reach_at(self.begin), self._reach_at(self.end)
        cuts = [self.begin, self.end]
        for share in (1e-4, 1e-3, 0.01, 0.05, 0.15, 0.3, 0.5, 0.75):
            reach = first + share * (last - first)
            angle = 2 * np.arctan2(reach - self.reach, 1 + reach * self.reach)
            cuts += [np.clip(angle, self.begin, self.end), self._angle(share, False)]
        edges = np.sort(np.array(cuts), axis=0)
        total = np.zeros_like(first)
        for low, high in itertools.pairwise(edges):
            for x, weight in zip(*np.polynomial.legendre.leggauss(16), strict=True):
                angle = (low + high) / 2 + (high - low) / 2 * x
                total += weight / 2 * (high - low) * self._lobe(angle) * self._attenuation(angle)
        return total

    def depths(self) -> tuple[np.ndarray, np.ndarray]:
        """Optical depth from the begin to the midpoint, and from there to the end."""
        middle = self._reach_at(self._angle(0.5, self.cosine))
        first = self.extinction * (middle - self._reach_at(self.begin))
        return first, self.depth - first


def envelope(features: np.ndarray, values: np.ndarray, quantile: float) -> np.ndarray:
    """Coefficients that `values` exceed in a share 1 - quantile of the rows only."""
    coefficients = np.linalg.lstsq(features, values, rcond=None)[0]
    for _ in range(80):
        residual = values - features @ coefficients
        weight = np.where(residual > 0, quantile, 1 - quantile) / np.maximum(abs(residual), 0.05)
        weighted = features * weight[:, None]
        coefficients = np.linalg.solve(weighted.T @ features, weighted.T @ values)
    return coefficients


def one_node(depth: np.ndarray, skew: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Envelope of log2 of the error of one node."""
    use = (error > 2e-5) & (error < 0.3)
    b, s = depth[use], skew[use]
    features = np.stack([np.ones_like(b), b, s, b * b, b * s, s * s], axis=1)
    return envelope(features, np.log2(error[use]), 0.999)


def several_nodes(
    depth: np.ndarray, skew: np.ndarray, errors: np.ndarray, generator: np.random.Generator
) -> np.ndarray:
    """Envelope of the number of nodes, two at least; errors are by rule and case."""
    rows, needs = [], []
    for tolerance in TOLERANCES:
        good = np.flip(np.logical_and.accumulate(np.flip(errors < SHARE * tolerance, 0), 0), 0)
        need = np.where(good.any(axis=0), np.argmax(good, axis=0) + 1, MOST_NODES)
        use = np.flatnonzero((need > 1) & (2**depth < np.log(1 + 8 / tolerance) + 2))
        use = generator.choice(use, min(len(use), 15_000), replace=False)
        b, s, c = depth[use], skew[use], np.full(len(use), -np.log2(tolerance))
        rows.append(np.stack(
            [np.ones_like(b), b, s, c, b * b, b * s, b * c, s * s, s * c, c * c], axis=1))
        needs.append(need[use] - 1.9)  # rounded up and one more, this gives `need`
    return envelope(np.concatenate(rows), np.concatenate(needs), 0.999)


def rows_of(shape: int) -> dict[str, np.ndarray]:
    """The fitted coefficients of one emitter."""
    generator = np.random.default_rng(20 + shape)
    intervals = Intervals(CASES * (1 + shape), shape == 1, generator)
    first, second = intervals.depths()
    exact = intervals.exact()
    graded = second > GRADED_FROM * first
    errors = []
    for nodes in range(1, MOST_NODES + 1):
        plain = intervals.rule(nodes, False)
        value = plain if nodes == 1 else np.where(graded, intervals.rule(nodes, True), plain)
        errors.append(abs(value / exact - 1))
    smaller = np.minimum(first, second)
    usable = smaller > 0
    depth = np.log2(np.where(usable, first + second, 1))
    skew = np.minimum(depth - np.log2(np.where(usable, smaller, 1)), 20)
    all_errors = np.array(errors)
    result = {"One": one_node(depth[usable], skew[usable], all_errors[0][usable])}
    for name, side in (("Plain", usable & ~graded), ("Graded", usable & graded)):
        result[name] = several_nodes(depth[side], skew[side], all_errors[:, side], generator)
    return result


def header() -> str:
    """The text of airlight_node_fit.h."""
    text = """// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Written by fit_airlight_nodes.py: edit that, not this. The quadratic forms that
// airlight_nodes.h evaluates. Binding-free.
#ifndef NIGHTCITY_TRANSPORT_AIRLIGHT_NODE_FIT_H
#define NIGHTCITY_TRANSPORT_AIRLIGHT_NODE_FIT_H

#include "arithmetic.h"

NIGHTCITY_BEGIN

"""
    fits = [rows_of(shape) for shape in range(len(SHAPES))]
    for name in fits[0]:
        size = len(fits[0][name])
        text += f"// {size} coefficients for each of: {', '.join(SHAPES)}.\n"
        text += f"NIGHTCITY_CONST float kAirlight{name}[{size * len(SHAPES)}] = {{\n"
        lines = []
        for fit in fits:
            numbers = [f"{value:.5f}f" for value in fit[name]]
            lines += ["    " + ", ".join(numbers[i : i + 5]) for i in range(0, size, 5)]
        text += ",\n".join(lines) + "};\n\n"
    return text + "NIGHTCITY_END\n\n#endif\n"


if __name__ == "__main__":
    print(header(), end="")
