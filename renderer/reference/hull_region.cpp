// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/hull_region.h"

#include <algorithm>
#include <limits>

namespace nightcity {

HullRegion::HullRegion(std::span<const glm::dvec3> source, glm::dvec3 begin, glm::dvec3 end) {
    std::vector<glm::dvec3> points(source.begin(), source.end());
    points.push_back(begin);
    points.push_back(end);
    for (const glm::dvec3 point : points) {
        bounds_.add(point);
    }
    const glm::dvec3 along = end - begin;
    // The planes through the stretch and the source: the sharpest.
    for (const glm::dvec3 corner : source.first(std::min<std::size_t>(4, source.size()))) {
        addSlab(points, glm::cross(along, corner - begin));
    }
    const glm::dvec3 u = source.size() > 1 ? source[1] - source[0] : glm::dvec3(0);
    const glm::dvec3 v = source.size() > 3 ? source[3] - source[0] : glm::dvec3(0);
    const glm::dvec3 middle = 0.5 * (source.front() + source[source.size() > 2 ? 2 : 0]);
    addSlab(points, glm::cross(u, v));
    addSlab(points, along);
    const glm::dvec3 normal = glm::cross(middle - begin, along);
    for (const glm::dvec3 edge : {u, v, normal}) {
        addSlab(points, glm::cross(edge, middle - begin));
        addSlab(points, glm::cross(edge, middle - end));
    }
}

void HullRegion::addSlab(std::span<const glm::dvec3> points, glm::dvec3 direction) {
    const double length = glm::length(direction);
    if (!(length > 0)) {
        return;  // separates nothing
    }
    Slab slab{direction / length, glm::abs(direction / length),
              std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const glm::dvec3 point : points) {
        const double place = glm::dot(slab.axis, point);
        slab.least = std::min(slab.least, place);
        slab.most = std::max(slab.most, place);
    }
    // Rounding of the axis itself moves the projections by this much.
    const double slack = 1e-9 * (1 + std::abs(slab.least) + std::abs(slab.most));
    slab.least -= slack;
    slab.most += slack;
    slabs_.push_back(slab);
}

// Separating axes.
bool HullRegion::mayTouch(const Bounds& box) const {
    if (!bounds_.touches(box)) {
        return false;
    }
    const glm::dvec3 centre = 0.5 * (box.lo + box.hi);
    const glm::dvec3 half = 0.5 * (box.hi - box.lo);
    return std::all_of(slabs_.begin(), slabs_.end(), [&](const Slab& slab) {
        const double middle = glm::dot(slab.axis, centre);
        const double reach = glm::dot(slab.size, half);
        return middle + reach >= slab.least && middle - reach <= slab.most;
    });
}

// Closer than its bounds, which are wide about a wall that is turned.
bool HullRegion::mayTouch(std::span<const glm::dvec3> convexFace) const {
    return std::all_of(slabs_.begin(), slabs_.end(), [&](const Slab& slab) {
        double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
        for (const glm::dvec3 point : convexFace) {
            const double place = glm::dot(slab.axis, point);
            lowest = std::min(lowest, place);
            highest = std::max(highest, place);
        }
        return highest >= slab.least && lowest <= slab.most;
    });
}

}  // namespace nightcity
