// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/exact_integral.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nightcity {

Accuracy judgeAccuracy(double tolerance, std::size_t windows) {
    constexpr std::size_t kManyWindows = 100'000;
    constexpr double kMillionth = 1e-6;
    const double leftOut =
        windows > kManyWindows ? std::max(kMillionth, tolerance / 100) : kMillionth;
    return {tolerance / 10, std::min(leftOut, tolerance / 100)};
}

ExactIntegral::ExactIntegral(const FlatScene& scene, int frame, const RenderSettings& settings,
                             const Accuracy& accuracy)
    : media_(settings.media),
      surfaces_(scene, frame),
      segments_(scene),
      lights_(scene, frame, settings),
      scattering_(lights_, accuracy),
      surfaceLight_(lights_, accuracy) {}

RayResult ExactIntegral::trace(const Ray& ray) const {
    RayResult result;
    result.surface = surfaces_.nearest(ray);
    const double farthest = result.surface.distance;
    const std::vector<Segment> segments = segments_.along(ray, farthest);
    if (media_) {
        const WindowSum glow = scattering_.along(ray, segments);
        double opticalDepth = 0;
        for (const Segment& segment : segments) {
            const MediaBox& box = lights_.mediaBoxes[segment.box];
            opticalDepth += double(box.extinction) * (segment.end - segment.begin);
            result.mediaId = result.mediaId < 0 ? float(box.mediaId) : result.mediaId;
        }
        result.glow = glow.value;
        result.lightEvaluations += glow.windows;
        result.transmittance = std::exp(-opticalDepth);
    }
    if (lights_.model.surfaces == Surfaces::lit && result.surface.reflectance != glm::dvec3(0)) {
        SurfacePoint point{ray.at(farthest), result.surface.normal, std::nullopt};
        if (!segments.empty() && segments.back().end == farthest) {
            point.box = segments.back().box;
        }
        const WindowSum light = surfaceLight_.irradiance(point);
        result.surface.radiance += result.surface.reflectance / std::numbers::pi * light.value;
        result.lightEvaluations += light.windows;
    }
    return result;
}

}  // namespace nightcity
