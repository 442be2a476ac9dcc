// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Single scattering of the listed windows, marched in double precision: the twin of
// the GPU's march, written to be obviously right (design section 4, model paper).
#pragma once

#include <cstdint>
#include <vector>

#include "reference/media_segments.h"
#include "reference/opaque_surfaces.h"
#include "reference/ray_integrator.h"
#include "settings.h"

namespace nightcity {

class March : public RayIntegrator {
public:
    // The scene must outlive it.
    March(const FlatScene& scene, int frame, const RenderSettings& settings);

    RayResult trace(const Ray& ray) const override;

private:
    glm::dvec3 inScatter(const MediaBox& box, const std::vector<std::uint32_t>& lights,
                         glm::dvec3 point) const;

    const FlatScene& scene_;
    std::uint32_t subdivisions_;
    bool media_;
    OpaqueSurfaces surfaces_;
    MediaSegments segments_;
    std::vector<std::vector<std::uint32_t>> litWindows_;  // of each media box
};

}  // namespace nightcity
