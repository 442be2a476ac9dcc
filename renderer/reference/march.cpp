// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/march.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/lit_lists.h"

namespace nightcity {

namespace {

// Below a micrometre from a window the inverse square is cut off: against a division
// by zero, not against brightness. m^2.
constexpr double kSmallestDistanceSquared = 1e-12;

}  // namespace

March::March(const FlatScene& scene, int frame, const RenderSettings& settings)
    : scene_(scene),
      subdivisions_(settings.subdivisions),
      media_(settings.media),
      surfaces_(scene, frame),
      segments_(scene),
      litWindows_(litLists(scene, frame, settings.lightCap)) {}

// Radiance scattered towards the eye, per metre: sigma_s / (4 pi) times the fluence
// of isotropic windows, P / (4 pi d^2) each, attenuated by the point's own box.
glm::dvec3 March::inScatter(const MediaBox& box, const std::vector<std::uint32_t>& lights,
                            glm::dvec3 point) const {
    const double extinction = box.extinction;
    glm::dvec3 fluence(0);
    for (const std::uint32_t index : lights) {
        const Window& window = scene_.windows[index];
        const glm::dvec3 toWindow = glm::dvec3(window.centre) - point;
        const double squared = std::max(glm::dot(toWindow, toWindow), kSmallestDistanceSquared);
        const double perArea = double(window.power) / (4 * std::numbers::pi * squared);
        fluence += perArea * std::exp(-extinction * std::sqrt(squared)) * glm::dvec3(window.colour);
    }
    const double scattering = extinction * double(box.albedo);
    return scattering / (4 * std::numbers::pi) * fluence;
}

RayResult March::trace(const Ray& ray) const {
    RayResult result;
    result.surface = surfaces_.nearest(ray);
    if (!media_) {
        return result;
    }
    double opticalDepth = 0;  // from the eye to the begin of the segment
    for (const Segment& segment : segments_.along(ray, result.surface.distance)) {
        const MediaBox& box = scene_.mediaBoxes[segment.box];
        const std::vector<std::uint32_t>& lights = litWindows_[segment.box];
        const double extinction = box.extinction;
        const double length = segment.end - segment.begin;
        const double step = length / subdivisions_;
        for (std::uint32_t i = 0; i < subdivisions_; ++i) {
            const double inside = (i + 0.5) * step;
            const double transmittance = std::exp(-(opticalDepth + extinction * inside));
            result.glow += inScatter(box, lights, ray.at(segment.begin + inside)) * transmittance * step;
        }
        result.lightEvaluations += std::uint64_t{subdivisions_} * lights.size();
        result.mediaId = result.mediaId < 0 ? float(box.mediaId) : result.mediaId;
        opticalDepth += extinction * length;
    }
    result.transmittance = std::exp(-opticalDepth);
    return result;
}

}  // namespace nightcity
