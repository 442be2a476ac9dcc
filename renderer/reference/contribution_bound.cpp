// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/contribution_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

namespace nightcity {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLargest = 1e100;   // keeps sums of bounds finite

// Fluence per watt of a Lambertian pane is P / (pi A) times a solid angle of at
// most 2 pi; away from the pane also P / (pi d^2) of its nearest point.
double paneIntegral(const Ray& ray, const LitWindow& window, double begin, double end) {
    const double area = 4 * glm::length(glm::cross(window.halfU, window.halfV));
    const double everywhere = 2 / area * (end - begin);
    const double foot = glm::dot(window.centre - ray.origin, ray.direction);
    const double nearest = glm::length(ray.at(std::clamp(foot, begin, end)) - window.centre);
    if (nearest <= window.reach) {
        return everywhere;
    }
    const double closer = nearest / (nearest - window.reach);
    return std::min(everywhere, closer * closer *
                                    inverseSquareIntegral(ray, window.centre, begin, end) / kPi);
}

}  // namespace

double inverseSquareIntegral(const Ray& ray, glm::dvec3 point, double begin, double end) {
    const double foot = glm::dot(point - ray.origin, ray.direction);
    const double h = glm::length(ray.at(foot) - point);
    const double a = begin - foot, b = end - foot;
    if (h == 0) {
        return a * b > 0 ? (b - a) / (a * b) : std::numeric_limits<double>::infinity();
    }
    return std::atan2(h * (b - a), h * h + a * b) / h;
}

double contributionBound(const Ray& ray, const HazeStretch& stretch, const LitWindow& window,
                         Emitter emitter) {
    double begin = stretch.begin, end = stretch.end;
    const PointSource source = window.pointSource(window.centre, emitter);
    std::tie(begin, end) = litPart(ray, source, begin, end);
    if (!(begin < end)) {
        return 0;
    }
    const double clear =
        window.isPane(emitter)
            ? paneIntegral(ray, window, begin, end)
            : inverseSquareIntegral(ray, window.centre, begin, end) /
                  (source.lobe == Lobe::isotropic ? 4 * kPi : kPi);
    return std::min(kLargest, stretch.scattering / (4 * kPi) * std::exp(-stretch.depthBefore) * clear);
}

}  // namespace nightcity
