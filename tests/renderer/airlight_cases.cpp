// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "airlight_cases.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nightcity {

double RandomNumbers::between(double low, double high) {
    return low + (high - low) * (double(bits_() >> 11) * 0x1p-53);
}

double RandomNumbers::logBetween(double low, double high) {
    return std::exp(between(std::log(low), std::log(high)));
}

glm::dvec3 RandomNumbers::direction() {
    const double z = between(-1, 1);
    const double turn = between(0, 2 * std::numbers::pi);
    const double side = std::sqrt(1 - z * z);
    return {side * std::cos(turn), side * std::sin(turn), z};
}

AirlightInterval exactInterval(double h, glm::dvec3 across, double ua, double span, double begin) {
    const double ub = ua + span;
    AirlightInterval i;
    i.foot = glm::vec3(h * across);
    i.h = float(h);
    i.begin = float(begin);
    i.span = float(span);
    i.ua = float(ua);
    i.ub = float(ub);
    i.da = float(std::hypot(h, ua));
    i.db = float(std::hypot(h, ub));
    return i;
}

PointCase randomPointCase(RandomNumbers& random) {
    const double span = random.logBetween(0.01, 2000);
    const double h = random.logBetween(1e-6, 300);
    const double away = random.logBetween(1e-4, 2000);
    const int place = int(random.between(0, 3));
    const double ua = place == 0   ? -span * random.between(0, 1)
                      : place == 1 ? away
                                   : -span - away;
    const glm::dvec3 direction = random.direction();
    const glm::dvec3 across = glm::normalize(glm::cross(direction, random.direction()));
    const double begin = random.between(0, 1) < 0.5 ? 0 : random.logBetween(0.01, 1000);
    const double extinction = random.between(0, 1) < 0.1 ? 0 : random.logBetween(1e-4, 10);
    return {exactInterval(h, across, ua, span, begin), glm::vec3(direction),
            glm::vec3(random.direction()), float(extinction)};
}

PointCase randomStreetCase(RandomNumbers& random) {
    const glm::dvec3 size(10, 10, 30);
    const glm::dvec3 inside = size * glm::dvec3(random.between(0, 1), random.between(0, 1),
                                                random.between(0, 1));
    const glm::dvec3 direction = random.direction();
    double first = -1e30, last = 1e30;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = -inside[axis] / direction[axis];
        const double b = (size[axis] - inside[axis]) / direction[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    const double side = random.between(0, 1) < 0.5 ? 0.01 : 9.99;
    const glm::dvec3 window(side, 2 * (1 + int(random.between(0, 4))),
                            5 * (1 + int(random.between(0, 5))));
    const double foot = glm::dot(window - inside, direction);
    const glm::dvec3 across = inside + foot * direction - window;
    const double h = glm::length(across);
    return {exactInterval(h, across / h, first - foot, last - first, 0), glm::vec3(direction),
            glm::vec3(side < 5 ? 1 : -1, 0, 0), 0.01f};
}

PaneCase randomPaneCase(RandomNumbers& random, double extinction) {
    while (true) {
        const double aspect = random.logBetween(1, 4);
        const double a = 0.5 * std::sqrt(aspect), b = 0.5 / std::sqrt(aspect);
        const glm::dvec3 onPane(random.between(-1.5, 1.5) * a, random.between(-1.5, 1.5) * b, 0);
        glm::dvec3 away = random.direction();
        away.z = std::abs(away.z);
        const glm::dvec3 place = onPane + random.logBetween(0.005, 20) * away;
        glm::dvec3 direction = random.direction();
        if (random.between(0, 1) < 1.0 / 3) {
            direction = glm::normalize(direction * glm::dvec3(1, 1, 0.05));
        }
        double first = -random.logBetween(0.05, 100), last = random.logBetween(0.05, 100);
        const double crossing = -place.z / direction.z;
        (direction.z > 0 ? first : last) =
            direction.z > 0 ? std::max(first, crossing) : std::min(last, crossing);
        if (last - first < 1e-3) {
            continue;
        }
        return {glm::vec3(place + first * direction), glm::vec3(direction),
                glm::vec3(a, 0, 0), glm::vec3(0, b, 0), 0, float(last - first), float(extinction)};
    }
}

int nodesTaken(const PointCase& c, bool lambertian, float tolerance) {
    const int emitter = lambertian ? kAirlightLambertian : kAirlightIsotropic;
    AirlightInterval i = c.interval;
    if (lambertian) {
        i = airlightBrightPart(i, airlightLobe(i, c.direction, c.normal));
    }
    i = airlightClipped(i, c.extinction, airlightClipDepth(tolerance, emitter));
    float middle = i.span * i.da / (i.da + i.db);
    if (lambertian) {
        AirlightLobe lobe = airlightLobe(i, c.direction, c.normal);
        lobe.atBegin = max(lobe.atBegin, 0.0f);
        lobe.atEnd = max(lobe.atEnd, 0.0f);
        middle = airlightStepOfSine(i, airlightSine(i, lobe), 0.5f);
    }
    const vec2 depths = airlightDepths(i, c.extinction, middle, airlightDistance(i, middle));
    return airlightRule(emitter, depths.x, depths.y, tolerance).count;
}

ErrorFigures errorFigures(std::vector<double> errors) {
    std::sort(errors.begin(), errors.end());
    const auto at = [&](double share) {
        return errors[std::size_t(share * double(errors.size() - 1))];
    };
    return {at(0.5), at(0.99), at(0.999), errors.back()};
}

}  // namespace nightcity
