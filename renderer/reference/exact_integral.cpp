// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/exact_integral.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nightcity {

Accuracy judgeAccuracy(double tolerance, std::size_t windows) {
    constexpr std::size_t kManyWindows = 10'000;
    const double hundredth = tolerance / 100;
    return {tolerance / 10, windows > kManyWindows ? hundredth : std::min(1e-6, hundredth)};
}

namespace {

void addStatedError(const WindowSum& sum, RayResult& result) {
    const double mean = (sum.value.x + sum.value.y + sum.value.z) / 3;
    if (mean > 0 && std::isfinite(mean)) {
        result.error = std::max(result.error, sum.error / mean);
        result.leftOut = std::max(result.leftOut, sum.leftOut / mean);
    }
}

}  // namespace

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
        addStatedError(glow, result);
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
        addStatedError(light, result);
        result.lightEvaluations += light.windows;
    }
    return result;
}

}  // namespace nightcity
