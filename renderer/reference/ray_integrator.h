// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What every way of computing a ray in double precision hands back.
#pragma once

#include <cstdint>

#include "reference/opaque_surfaces.h"
#include "reference/ray.h"

namespace nightcity {

// Radiance in W m^-2 sr^-1.
struct RayResult {
    glm::dvec3 glow{0};
    double transmittance = 1;
    SurfaceHit surface;    // its radiance is that at the surface, before the haze
    float mediaId = -1;    // of the first media box on the ray
    std::uint64_t lightEvaluations = 0;
    // Of an exact integral: bounds of what it is off by and of what it leaves out,
    // relative to the mean of the channels; the larger of glow and surface light.
    double error = 0;
    double leftOut = 0;
};

class RayIntegrator {
public:
    virtual ~RayIntegrator() = default;
    virtual RayResult trace(const Ray& ray) const = 0;
};

}  // namespace nightcity
