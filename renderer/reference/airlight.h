// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Light of a point source that is scattered once, along a part of a ray from which
// the whole source is seen.
#pragma once

#include <glm/glm.hpp>

#include "reference/adaptive_quadrature.h"
#include "reference/haze.h"
#include "reference/ray.h"

namespace nightcity {

// A part of a ray inside one medium.
struct HazeStretch {
    double begin = 0;         // m along the ray
    double end = 0;
    double extinction = 0;    // 1/m
    double scattering = 0;    // 1/m
    double depthBefore = 0;   // optical depth from the eye to `begin`
};

enum class Lobe {
    isotropic,  // intensity P / 4 pi
    cosine,     // intensity P cos / pi, to the side of the normal only
};

struct PointSource {
    glm::dvec3 place{0};   // m
    glm::dvec3 normal{0};  // unit vector, of a cosine lobe
    Lobe lobe = Lobe::isotropic;
    double radius = 0;     // m; no light inside (a sphere)
};

// The part of [begin, end] on the bright side of a cosine lobe; begin > end: none.
std::pair<double, double> litPart(const Ray& ray, const PointSource& source, double begin,
                                  double end);

// Radiance at the eye per watt (m^-2 sr^-1), from [begin, end] within the stretch.
// `depth` belongs to just this part. Infinite where the ray goes through the
// source itself.
Estimate airlight(const Ray& ray, const HazeStretch& stretch, double begin, double end,
                  const PointSource& source, const SourceDepth& depth, const Tolerance& tolerance);

}  // namespace nightcity
