// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the planes nearly equal to a given one, among many.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include <glm/glm.hpp>

namespace nightcity {

class PlaneIndex {
public:
    // Planes within `radius` (m) of `reference`.
    PlaneIndex(glm::dvec3 reference, double radius);

    void add(std::uint32_t plane, glm::dvec3 normal, glm::dvec3 point);

    // visit(plane) for every plane whose normal is within kNormalTolerance and which
    // is within kOffsetTolerance of `point`, and for some others; for some twice.
    template <typename Visit>
    void visitNear(glm::dvec3 normal, glm::dvec3 point, Visit&& visit) const {
        const glm::dvec4 place = coordinates(normal, point);
        for (unsigned neighbour = 0; neighbour < 16; ++neighbour) {
            const auto [first, last] = planes_.equal_range(key(place, neighbour));
            for (auto it = first; it != last; ++it) {
                visit(it->second);
            }
        }
    }

    static constexpr double kNormalTolerance = 0.01;  // length of the difference of unit normals
    static constexpr double kOffsetTolerance = 0.05;  // m

private:
    // In cells twice as large as what equal planes may differ by.
    glm::dvec4 coordinates(glm::dvec3 normal, glm::dvec3 point) const;
    // Of the cell of `place`, or in each direction whose bit is set the nearest other.
    static std::uint64_t key(glm::dvec4 place, unsigned neighbour);

    glm::dvec3 reference_;
    double offsetCell_;
    std::unordered_multimap<std::uint64_t, std::uint32_t> planes_;
};

}  // namespace nightcity
