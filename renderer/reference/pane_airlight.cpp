// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/pane_airlight.h"

#include <cmath>
#include <numbers>

#include "reference/contribution_bound.h"
#include "reference/pane_fluence.h"

namespace nightcity {

namespace {

constexpr double kPi = std::numbers::pi;
// Of the pane's tolerance, for the mean transmittance at each place.
constexpr double kInnerShare = 0.25;

// t = foot + h tan(angle): evens the inverse square out.
class TangentVariable {
public:
    TangentVariable(const Ray& ray, const LitWindow& window)
        : foot_(glm::dot(window.centre - ray.origin, ray.direction)) {
        const double distance = glm::length(ray.at(foot_) - window.centre);
        height_ = std::max(distance, 0.25 * window.reach);  // a pane has no pole
    }

    double angle(double t) const { return std::atan2(t - foot_, height_); }
    double t(double angle) const { return foot_ + height_ * std::tan(angle); }
    double slope(double t) const {  // dt / d angle
        const double along = (t - foot_) / height_;
        return height_ * (1 + along * along);
    }

private:
    double foot_, height_;
};

}  // namespace

Estimate paneAirlight(const Ray& ray, const HazeStretch& stretch, const RayPart& part,
                      const LitWindow& window, const PaneSight& sight, const HazeBetween& haze,
                      const Tolerance& tolerance) {
    const double area = 4 * glm::length(glm::cross(window.halfU, window.halfV));
    const double perWatt = stretch.scattering / (4 * kPi) / (kPi * area);
    HazeStretch within = stretch;
    within.begin = part.begin;
    within.end = part.end;
    within.depthBefore += stretch.extinction * (part.begin - stretch.begin);
    const double most = contributionBound(ray, within, window, Emitter::pane);
    if (!(most > 0)) {
        return {};
    }
    const TangentVariable variable(ray, window);
    const double relative =
        kInnerShare * std::max(tolerance.relative, tolerance.absolute / most);
    PanePolygons seen;
    double innerError = 0;
    const auto integrand = [&](double angle) {
        const double t = variable.t(angle);
        sight.seenFrom(t, seen);
        if (seen.size() == 0) {
            return 0.0;
        }
        const double eyeDepth = within.depthBefore + stretch.extinction * (t - part.begin);
        const Estimate received = dimmedSolidAngle(window, seen, ray.at(t), haze, relative);
        if (received.value > 0) {
            innerError = std::max(innerError, received.error / received.value);
        }
        return received.value * std::exp(-eyeDepth) * variable.slope(t);
    };
    std::vector<double> breaks{variable.angle(part.begin)};
    for (const double kink : sight.kinks()) {
        if (kink > part.begin && kink < part.end) {
            breaks.push_back(variable.angle(kink));
        }
    }
    breaks.push_back(variable.angle(part.end));
    const Tolerance outer{tolerance.absolute / perWatt, tolerance.relative};
    Estimate sum = integrate(integrand, breaks, outer, kKronrod7);
    sum.error += innerError * sum.value;
    return {sum.value * perWatt, sum.error * perWatt};
}

}  // namespace nightcity
