// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Light of a pane that is scattered once: at each place of the ray the solid angle of
// what is seen of the pane, integrated along the ray.
#pragma once

#include <span>

#include "reference/adaptive_quadrature.h"
#include "reference/airlight.h"
#include "reference/pane_sight.h"

namespace nightcity {

// Radiance at the eye per watt (m^-2 sr^-1), from a part of one stretch in front of
// the pane.
Estimate paneAirlight(const Ray& ray, const HazeStretch& stretch, const RayPart& part,
                      const LitWindow& window, const PaneSight& sight, const HazeBetween& haze,
                      const Tolerance& tolerance);

}  // namespace nightcity
