// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What a point receives from parts of a pane.
#pragma once

#include "reference/adaptive_quadrature.h"
#include "reference/emitters.h"
#include "reference/haze.h"
#include "reference/pane_polygons.h"

namespace nightcity {

// Solid angle (sr) of parts of a pane, seen from a point off its plane.
double solidAngle(const LitWindow& window, const PanePolygons& parts, glm::dvec3 eye);

// The same, each direction weighed by the transmittance of the haze on its way: the
// integral of exp(-depth) cos / d^2 over the parts. The error is `relative` of it, and
// above only where 20,000 cells were not enough. Not in it: the rest of a kink where
// the border of a haze is seen in front of the pane, below 1 % of the depths' contrast.
Estimate dimmedSolidAngle(const LitWindow& window, const PanePolygons& parts, glm::dvec3 eye,
                          const HazeBetween& haze, double relative);

}  // namespace nightcity
