// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/airlight.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace nightcity {

namespace {

constexpr double kPi = std::numbers::pi;

// The ray about the foot of the perpendicular from the source.
struct Foot {
    double t;             // m along the ray
    glm::dvec3 fromSource;
    double distance;      // m, source to foot

    Foot(const Ray& ray, glm::dvec3 source) {
        t = glm::dot(source - ray.origin, ray.direction);
        fromSource = ray.at(t) - source;
        // What rounding left along the ray would spoil a short perpendicular.
        fromSource -= glm::dot(fromSource, ray.direction) * ray.direction;
        distance = glm::length(fromSource);
    }
};

// Lets t run away from the foot, on one side: u = |t - t_foot| > 0. With
// v = atan(h / u) / h, which is 1 / u for h = 0, dt / d^2 = -dv: the inverse square
// is gone, and no small difference of large angles appears.
class OneSide {
public:
    OneSide(const Foot& foot, double side) : foot_(foot), side_(side) {}

    double variable(double u) const {
        const double h = foot_.distance;
        return h > 0 ? std::atan2(h, u) / h : 1 / u;
    }
    double u(double v) const {
        const double h = foot_.distance;
        return h > 0 ? h / std::tan(h * v) : 1 / v;
    }
    double side() const { return side_; }

private:
    const Foot& foot_;
    double side_;  // 1 behind the foot, -1 before it
};

// [begin, end] lies on one side of the foot.
Estimate integrateSide(const Ray& ray, const HazeStretch& stretch, double begin, double end,
                       const PointSource& source, const Foot& foot,
                       std::span<const double> kinks, const SourceDepth& depth,
                       const Tolerance& tolerance) {
    const OneSide way(foot, begin >= foot.t ? 1 : -1);
    const double h = foot.distance;
    const double cosineAtFoot = glm::dot(source.normal, foot.fromSource);
    const double cosineSlope = glm::dot(source.normal, ray.direction);
    const auto integrand = [&](double v) {
        const double u = std::max(0.0, way.u(v));
        const double t = foot.t + way.side() * u;
        const double distance = std::sqrt(h * h + u * u);
        const double eyeDepth = stretch.depthBefore + stretch.extinction * (t - stretch.begin);
        const double sourceDepth = depth.at(ray.at(t), distance);
        const double lobe =
            source.lobe == Lobe::isotropic
                ? 0.25
                : std::max(0.0, cosineAtFoot + way.side() * u * cosineSlope) / distance;
        return lobe * std::exp(-std::max(0.0, eyeDepth) - sourceDepth);
    };
    std::vector<double> breaks;
    for (const double t : {begin, end}) {
        breaks.push_back(way.variable(std::abs(t - foot.t)));
    }
    for (const double t : kinks) {
        if (t > begin && t < end) {
            breaks.push_back(way.variable(std::abs(t - foot.t)));
        }
    }
    if (!std::isfinite(*std::max_element(breaks.begin(), breaks.end()))) {
        return {std::numeric_limits<double>::infinity(), 0};
    }
    std::sort(breaks.begin(), breaks.end());
    return integrate(integrand, breaks, tolerance);
}

// The parts of [begin, end] outside a ball about the foot's source.
std::vector<std::pair<double, double>> outsideBall(const Foot& foot, double radius, double begin,
                                                   double end) {
    const double half = std::sqrt(std::max(0.0, radius * radius - foot.distance * foot.distance));
    if (half == 0) {
        return {{begin, end}};
    }
    return {{begin, std::min(end, foot.t - half)}, {std::max(begin, foot.t + half), end}};
}

}  // namespace

std::pair<double, double> litPart(const Ray& ray, const PointSource& source, double begin,
                                  double end) {
    if (source.lobe == Lobe::isotropic) {
        return {begin, end};
    }
    const double atOrigin = glm::dot(source.normal, ray.origin - source.place);
    const double slope = glm::dot(source.normal, ray.direction);
    if (slope == 0) {
        return atOrigin > 0 ? std::pair{begin, end} : std::pair{1.0, 0.0};
    }
    const double edge = -atOrigin / slope;
    return slope > 0 ? std::pair{std::max(begin, edge), end} : std::pair{begin, std::min(end, edge)};
}

Estimate airlight(const Ray& ray, const HazeStretch& stretch, double begin, double end,
                  const PointSource& source, const SourceDepth& depth, const Tolerance& tolerance) {
    const Foot foot(ray, source.place);
    std::vector<double> kinks;
    for (const double fraction : depth.kinks()) {
        kinks.push_back(begin + fraction * (end - begin));
    }
    const auto [litBegin, litEnd] = litPart(ray, source, begin, end);
    const double perWatt = stretch.scattering / (4 * kPi) / kPi;
    const Tolerance inside{perWatt > 0 ? tolerance.absolute / (4 * perWatt) : 0, tolerance.relative};
    Estimate total;
    for (const auto& [first, last] : outsideBall(foot, source.radius, litBegin, litEnd)) {
        const double middle = std::clamp(foot.t, first, std::max(first, last));
        for (const auto& [a, b] : {std::pair{first, middle}, {middle, last}}) {
            if (a < b) {
                total += integrateSide(ray, stretch, a, b, source, foot, kinks, depth, inside);
            }
        }
    }
    return {total.value * perWatt, total.error * perWatt};
}

}  // namespace nightcity
