// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/height_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace nightcity {
namespace {

using Face = std::span<const glm::dvec3>;

// Of the normal: steeper faces are as good as upright, and cover no cell's centre.
constexpr double kLeastUpward = 1e-6;

bool looksUpward(Face face) {
    const glm::dvec3 area = areaVector(face);
    return area.z > kLeastUpward * glm::length(area);
}

struct Extent {
    glm::dvec2 lo{std::numeric_limits<double>::infinity()};
    glm::dvec2 hi{-std::numeric_limits<double>::infinity()};
    void add(const glm::dvec3& corner) {
        lo = glm::min(lo, glm::dvec2(corner));
        hi = glm::max(hi, glm::dvec2(corner));
    }
};

Extent extentOf(Face face) {
    Extent extent;
    for (const glm::dvec3& corner : face) {
        extent.add(corner);
    }
    return extent;
}

// Whether a place lies inside a convex face that goes counter-clockwise, both seen from above.
bool covers(Face face, glm::dvec2 place) {
    for (std::size_t i = 0; i < face.size(); ++i) {
        const glm::dvec2 from(face[i]);
        const glm::dvec2 edge = glm::dvec2(face[(i + 1) % face.size()]) - from;
        const glm::dvec2 to = place - from;
        if (edge.x * to.y - edge.y * to.x < 0) {
            return false;
        }
    }
    return true;
}

void raise(HeightMap& map, Face face) {
    const glm::dvec2 origin(map.origin);
    const double side = map.cellSide;
    const Extent extent = extentOf(face);
    const glm::dvec2 most = glm::dvec2(map.counts) - 1.0;
    const auto first = uvec2(glm::clamp(glm::floor((extent.lo - origin) / side), glm::dvec2(0), most));
    const auto last = uvec2(glm::clamp(glm::floor((extent.hi - origin) / side), glm::dvec2(0), most));
    const glm::dvec3 normal = areaVector(face);
    for (uint y = first.y; y <= last.y; ++y) {
        for (uint x = first.x; x <= last.x; ++x) {
            const glm::dvec2 centre = origin + (glm::dvec2(x, y) + 0.5) * side;
            if (covers(face, centre)) {
                const glm::dvec2 way = centre - glm::dvec2(face[0]);
                const double height =
                    face[0].z - (normal.x * way.x + normal.y * way.y) / normal.z;
                float& cell = map.heights[std::size_t{y} * map.counts.x + x];
                cell = std::max(cell, float(height));
            }
        }
    }
}

}  // namespace

HeightMap buildHeightMap(const ConvexFaces& faces, float cellSide) {
    HeightMap map;
    map.heights = {kNoRoof};
    Extent all;
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
        if (looksUpward(faces.face(i))) {
            const Extent extent = extentOf(faces.face(i));
            all.lo = glm::min(all.lo, extent.lo);
            all.hi = glm::max(all.hi, extent.hi);
        }
    }
    if (!(all.lo.x < all.hi.x)) {
        return map;
    }
    const glm::dvec2 size = all.hi - all.lo;
    const auto cells = [&](double side) { return glm::ceil(size / side + 1e-6); };
    double side = cellSide;
    while (cells(side).x * cells(side).y > double(kHeightMapBytes / sizeof(float))) {
        side *= 1.05;
    }
    map.cellSide = float(side);
    map.origin = vec2(all.lo);
    map.counts = uvec2(cells(side));
    map.heights.assign(std::size_t{map.counts.x} * map.counts.y, kNoRoof);
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
        if (looksUpward(faces.face(i))) {
            raise(map, faces.face(i));
        }
    }
    return map;
}

}  // namespace nightcity
