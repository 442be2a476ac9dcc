// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The windows that are on, in double precision.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "reference/airlight.h"
#include "scene/flat_scene.h"
#include "settings.h"

namespace nightcity {

struct LitWindow {
    std::uint32_t window;   // into FlatScene::windows
    glm::dvec3 centre;      // m
    glm::dvec3 halfU, halfV;
    glm::dvec3 normal;      // unit vector, outward
    glm::dvec3 power;       // W, per channel
    double reach;           // m, from the centre to the farthest point of the emitter
    bool sphere;

    // The mean of the channels: what tolerances are measured on.
    double meanPower() const { return (power.x + power.y + power.z) / 3; }
    // From (u, v) in [-1, 1]^2 on the pane.
    glm::dvec3 at(glm::dvec2 uv) const { return centre + uv.x * halfU + uv.y * halfV; }
    // In order about the pane.
    std::array<glm::dvec3, 4> corners() const {
        return {at({-1, -1}), at({1, -1}), at({1, 1}), at({-1, 1})};
    }
    // A point of the pane as the model has it. A sphere is isotropic in every model.
    PointSource pointSource(glm::dvec3 place, Emitter emitter) const;
    bool isPane(Emitter emitter) const { return emitter == Emitter::pane && !sphere; }
};

// By ascending index; windows without power are none.
std::vector<LitWindow> litWindows(const FlatScene& scene, int frame);

}  // namespace nightcity
