// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The most that a window can bring: what it would bring through clear air.
#pragma once

#include "reference/emitters.h"

namespace nightcity {

// Integral of dt / d^2 over [begin, end] of a ray, d the distance from `point`.
double inverseSquareIntegral(const Ray& ray, glm::dvec3 point, double begin, double end);

// Radiance per watt of one window's light scattered in a stretch: never below the
// true value, whatever lies between. At most 1e100.
double contributionBound(const Ray& ray, const HazeStretch& stretch, const LitWindow& window,
                         Emitter emitter);

}  // namespace nightcity
