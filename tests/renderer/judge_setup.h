// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What the tests of the judge share: settings, one ray's glow, a lone window.
#pragma once

#include <cmath>
#include <numbers>

#include "reference/exact_integral.h"
#include "scene_builder.h"

namespace nightcity {

inline constexpr double kPi = std::numbers::pi;
inline constexpr Accuracy kFine{1e-11, 1e-12};

inline RenderSettings exactModel(Emitter emitter, Visibility visibility = Visibility::full,
                                 Lights lights = Lights::all) {
    RenderSettings settings;
    settings.model.lights = lights;
    settings.model.visibility = visibility;
    settings.model.emitter = emitter;
    return settings;
}

inline Ray through(glm::dvec3 from, glm::dvec3 to) {
    return {from, glm::normalize(to - from)};
}

// Red of the glow: windows here are white.
inline double glow(const FlatScene& scene, const RenderSettings& settings, const Ray& ray,
                   const Accuracy& accuracy = kFine) {
    return ExactIntegral(scene, 1, settings, accuracy).trace(ray).glow.x;
}

// A pane of 50 W that shines along +y or, with `towards` -1, along -y.
inline void addFreeWindow(SceneBuilder& city, vec3 centre, float towards = 1, float halfWidth = 0.5f,
                          float halfHeight = 0.75f, float power = 50) {
    city.addWindow(centre, {-towards * halfWidth, 0, 0}, {0, 0, halfHeight}, power, vec3(1), false);
}

// sigma_s / (4 pi) of the first box.
inline double phaseScattering(const SceneBuilder& city) {
    return double(city.mediaBoxes[0].extinction) * double(city.mediaBoxes[0].albedo) / (4 * kPi);
}

}  // namespace nightcity
