// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/plane_index.h"

#include <algorithm>

namespace nightcity {

// Two normals that differ by kNormalTolerance part by that times the distance from
// the point where the planes meet.
PlaneIndex::PlaneIndex(glm::dvec3 reference, double radius)
    : reference_(reference), offsetCell_(2 * (kOffsetTolerance + kNormalTolerance * radius)) {}

void PlaneIndex::add(std::uint32_t plane, glm::dvec3 normal, glm::dvec3 point) {
    planes_.emplace(key(coordinates(normal, point), 0), plane);
}

glm::dvec4 PlaneIndex::coordinates(glm::dvec3 normal, glm::dvec3 point) const {
    return {normal / (2 * kNormalTolerance), glm::dot(normal, point - reference_) / offsetCell_};
}

std::uint64_t PlaneIndex::key(glm::dvec4 place, unsigned neighbour) {
    std::uint64_t hash = 0;
    for (int i = 0; i < 4; ++i) {
        double cell = std::clamp(std::floor(place[i]), -1e18, 1e18);  // fits 64 bits
        if ((neighbour >> i & 1u) != 0) {
            cell += place[i] - cell < 0.5 ? -1 : 1;
        }
        hash = (hash ^ std::uint64_t(std::int64_t(cell))) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash;
}

}  // namespace nightcity
