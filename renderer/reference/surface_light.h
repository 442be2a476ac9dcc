// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Light that falls from the windows straight on a point of a surface, or reaches a point in
// the haze.
#pragma once

#include <cstdint>
#include <optional>

#include "reference/hiders.h"
#include "reference/light_scene.h"
#include "reference/window_sum.h"

namespace nightcity {

struct SurfacePoint {
    glm::dvec3 place{0};   // m
    glm::dvec3 normal{0};  // unit vector, to the side that is seen; 0: no surface, but a point in
                           // the haze, whose fluence is meant where this says irradiance
    // The media box that the seen side lies in, into LightScene::mediaBoxes. Listed
    // lights and attenuation without visibility are those of this box; none: no
    // listed light, and clear air.
    std::optional<std::uint32_t> box;
};

class SurfaceLight {
public:
    // `lights` must outlive it.
    SurfaceLight(const LightScene& lights, const Accuracy& accuracy);

    // Irradiance, W m^-2.
    WindowSum irradiance(const SurfacePoint& point) const;
    // m^-2: irradiance per watt.
    Estimate fromWindow(const SurfacePoint& point, const LitWindow& window,
                        const Tolerance& tolerance) const;

private:
    // What may stand between the two.
    Hiders hidersOf(const SurfacePoint& point, const LitWindow& window) const;
    double fromPoint(const SurfacePoint& point, const LitWindow& window) const;
    Estimate fromPane(const SurfacePoint& point, const LitWindow& window,
                      const Tolerance& tolerance) const;
    Estimate fromLine(const SurfacePoint& point, const LitWindow& window,
                      const Hiders& hiders, double v,
                      const Tolerance& tolerance) const;
    double ownExtinction(const SurfacePoint& point) const;

    const LightScene& lights_;
    Accuracy accuracy_;
};

}  // namespace nightcity
