// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Single scattering by plain steps, with its own test of visibility and its own
// optical depth: slow, inexact at edges, and sharing no code with the judge.
#pragma once

#include <array>
#include <vector>

#include <glm/glm.hpp>

#include "scene/flat_scene.h"
#include "settings.h"

namespace nightcity {

class BruteForce {
public:
    BruteForce(const FlatScene& scene, const Model& model);

    // Glow of a ray (unit direction) up to `farthest` (m): midpoints of `steps` equal
    // steps, each pane `side` x `side` points.
    glm::dvec3 glow(glm::dvec3 origin, glm::dvec3 direction, double farthest, int steps,
                    int side) const;
    // Distance of the first triangle or of the ground, infinity for none.
    double firstSurface(glm::dvec3 origin, glm::dvec3 direction) const;
    // Irradiance of a point with normal, windows as above.
    glm::dvec3 irradiance(glm::dvec3 point, glm::dvec3 normal, int side) const;

private:
    struct Light {
        glm::dvec3 place, normal, power;
    };

    std::vector<Light> lights(int side) const;
    bool visible(glm::dvec3 a, glm::dvec3 b) const;
    double opticalDepth(glm::dvec3 a, glm::dvec3 b) const;
    // Flux through a sphere's unit area about `point`, W m^-2; without haze and walls.
    double clearFluence(const Light& light, glm::dvec3 point) const;

    const FlatScene& scene_;
    Model model_;
    std::vector<std::array<glm::dvec3, 3>> triangles_;
};

}  // namespace nightcity
