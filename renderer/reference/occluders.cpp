// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/occluders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace nightcity {

namespace {

// Everything between a ball and a stretch lies within `radius` of the triangle
// from the ball's centre to the stretch.
struct ThickTriangle {
    std::array<glm::dvec3, 3> corner;
    double radius;
    Bounds bounds;
    std::array<glm::dvec3, 4> axis;      // unit normal, and those of the edges in the plane
    std::array<double, 4> least, most;   // the triangle along each axis, with the radius

    ThickTriangle(glm::dvec3 point, double ballRadius, glm::dvec3 begin, glm::dvec3 end);
    bool mayTouch(const Bounds& box) const;
    bool mayTouch(std::span<const glm::dvec3> face) const;
};

ThickTriangle::ThickTriangle(glm::dvec3 point, double ballRadius, glm::dvec3 begin, glm::dvec3 end)
    : corner{point, begin, end}, radius(ballRadius) {
    for (const glm::dvec3 c : corner) {
        bounds.add(c - radius);
        bounds.add(c + radius);
    }
    const glm::dvec3 normal = glm::cross(begin - point, end - point);
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec3 across =
            i == 3 ? normal : glm::cross(normal, corner[(i + 1) % 3] - corner[i]);
        const double length = glm::length(across);
        axis[i] = length > 0 ? across / length : glm::dvec3(0);  // 0 separates nothing
        const double a = glm::dot(axis[i], corner[0]);
        const double b = glm::dot(axis[i], corner[1]);
        const double c = glm::dot(axis[i], corner[2]);
        // Rounding of the axis itself moves the projections by this much.
        const double slack = 1e-9 * (1 + std::abs(a) + std::abs(b) + std::abs(c));
        least[i] = std::min({a, b, c}) - radius - slack;
        most[i] = std::max({a, b, c}) + radius + slack;
    }
}

// Separating axes; never false for a box that touches.
bool ThickTriangle::mayTouch(const Bounds& box) const {
    if (!bounds.touches(box)) {
        return false;
    }
    const glm::dvec3 centre = 0.5 * (box.lo + box.hi);
    const glm::dvec3 half = 0.5 * (box.hi - box.lo);
    for (std::size_t i = 0; i < 4; ++i) {
        const double middle = glm::dot(axis[i], centre);
        const double reach = glm::dot(glm::abs(axis[i]), half);
        if (middle + reach < least[i] || middle - reach > most[i]) {
            return false;
        }
    }
    return true;
}

// Closer than its bounds, which are wide about a wall that is turned.
bool ThickTriangle::mayTouch(std::span<const glm::dvec3> face) const {
    for (std::size_t i = 0; i < 4; ++i) {
        double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
        for (const glm::dvec3 point : face) {
            const double place = glm::dot(axis[i], point);
            lowest = std::min(lowest, place);
            highest = std::max(highest, place);
        }
        if (highest < least[i] || lowest > most[i]) {
            return false;
        }
    }
    return true;
}

}  // namespace

Occluders::Occluders(const FlatScene& scene) : faces_(scene), tree_(faces_.bounds()) {
    if (scene.ground) {
        groundHeight_ = double(scene.ground->height);
    }
}

std::vector<std::uint32_t> Occluders::between(glm::dvec3 point, double radius, glm::dvec3 begin,
                                              glm::dvec3 end) const {
    const ThickTriangle region(point, radius, begin, end);
    std::vector<std::uint32_t> faces;
    tree_.visitWhere([&](const Bounds& box) { return region.mayTouch(box); },
                      [&](std::uint32_t index) {
                          if (region.mayTouch(face(index))) {
                              faces.push_back(index);
                          }
                      });
    std::sort(faces.begin(), faces.end());
    return faces;
}

}  // namespace nightcity
