// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/far_media.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <tuple>

namespace nightcity {
namespace {

// With more levels than this nothing is cut: every cut makes boxes before joining does away
// with them.
constexpr std::size_t kMostLevels = 8;

struct Haze {
    FarMedium medium;
    bool real = true;  // not only the inside of a building
};

bool isHazy(const MediaBox& box) {
    return box.extinction > 0;
}

// The bounds of a building that fills them: twelve triangles that cover the six faces.
std::optional<std::pair<vec3, vec3>> solidBox(const FlatScene& scene, const Building& building) {
    if (building.triangleCount != 12) {
        return std::nullopt;
    }
    vec3 lo(scene.positions[scene.triangles[building.firstTriangle].vertex.x]), hi = lo;
    const auto triangles = scene.triangles.subspan(building.firstTriangle, 12);
    for (const Triangle& triangle : triangles) {
        for (int i = 0; i < 3; ++i) {
            lo = glm::min(lo, scene.positions[triangle.vertex[i]]);
            hi = glm::max(hi, scene.positions[triangle.vertex[i]]);
        }
    }
    std::array<double, 6> area{};  // twice that of the triangles in each plane
    for (const Triangle& triangle : triangles) {
        const vec3 a = scene.positions[triangle.vertex.x];
        const vec3 b = scene.positions[triangle.vertex.y];
        const vec3 c = scene.positions[triangle.vertex.z];
        const glm::dvec3 origin(a);
        const glm::dvec3 normal = glm::cross(glm::dvec3(b) - origin, glm::dvec3(c) - origin);
        for (int axis = 0; axis < 3; ++axis) {
            if (a[axis] == b[axis] && b[axis] == c[axis]) {
                if (a[axis] == lo[axis]) {
                    area[std::size_t(axis)] -= normal[axis];
                } else if (a[axis] == hi[axis]) {
                    area[std::size_t(axis) + 3] += normal[axis];
                }
            }
        }
    }
    const glm::dvec3 size = glm::dvec3(hi) - glm::dvec3(lo);
    for (int axis = 0; axis < 3; ++axis) {
        const double face = 2 * size[(axis + 1) % 3] * size[(axis + 2) % 3];
        for (const std::size_t side : {std::size_t(axis), std::size_t(axis) + 3}) {
            if (!(std::abs(area[side] - face) <= 1e-6 * face)) {
                return std::nullopt;
            }
        }
    }
    return std::pair{lo, hi};
}

std::vector<Haze> hazeBoxes(const FlatScene& scene) {
    std::vector<Haze> boxes;
    bool oneHaze = true;
    for (const MediaBox& box : scene.mediaBoxes) {
        if (isHazy(box)) {
            boxes.push_back({{box.lo, box.extinction, box.hi, box.extinction * box.albedo}});
            const FarMedium &first = boxes.front().medium, &last = boxes.back().medium;
            oneHaze &= first.extinction == last.extinction && first.scattering == last.scattering;
        }
    }
    if (boxes.empty() || !oneHaze) {
        return boxes;
    }
    for (const Building& building : scene.buildings) {
        if (const auto solid = solidBox(scene, building)) {
            Haze filler = boxes.front();
            filler.medium.lo = solid->first;
            filler.medium.hi = solid->second;
            filler.real = false;
            boxes.push_back(filler);
        }
    }
    return boxes;
}

// At the heights where any box begins or ends, so that what lies below the lowest roof can join.
void cutAtLevels(std::vector<Haze>& boxes) {
    std::set<float> levels;
    for (const Haze& box : boxes) {
        levels.insert({box.medium.lo.z, box.medium.hi.z});
    }
    if (levels.size() > kMostLevels) {
        return;
    }
    std::vector<Haze> cut;
    for (Haze box : boxes) {
        const float top = box.medium.hi.z;
        for (auto level = levels.upper_bound(box.medium.lo.z); *level < top; ++level) {
            box.medium.hi.z = *level;
            cut.push_back(box);
            box.medium.lo.z = *level;
        }
        box.medium.hi.z = top;
        cut.push_back(box);
    }
    boxes = std::move(cut);
}

// Joins along one axis; returns whether any did.
bool joinAlong(std::vector<Haze>& boxes, int axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto row = [&](const Haze& box) {
        const FarMedium& m = box.medium;
        return std::tuple(m.lo[u], m.hi[u], m.lo[v], m.hi[v], m.extinction, m.scattering);
    };
    std::stable_sort(boxes.begin(), boxes.end(), [&](const Haze& a, const Haze& b) {
        const auto rowA = row(a), rowB = row(b);
        return rowA != rowB ? rowA < rowB : a.medium.lo[axis] < b.medium.lo[axis];
    });
    std::vector<Haze> joined;
    for (const Haze& box : boxes) {
        if (!joined.empty() && row(joined.back()) == row(box) &&
            joined.back().medium.hi[axis] == box.medium.lo[axis]) {
            joined.back().medium.hi[axis] = box.medium.hi[axis];
            joined.back().real |= box.real;
        } else {
            joined.push_back(box);
        }
    }
    const bool any = joined.size() < boxes.size();
    boxes = std::move(joined);
    return any;
}

}  // namespace

std::vector<FarMedium> mergeMedia(const FlatScene& scene) {
    std::vector<Haze> boxes = hazeBoxes(scene);
    cutAtLevels(boxes);
    while (joinAlong(boxes, 0) | joinAlong(boxes, 1) | joinAlong(boxes, 2)) {
    }
    std::vector<FarMedium> media;
    for (const Haze& box : boxes) {
        if (box.real) {
            media.push_back(box.medium);
        }
    }
    return media;
}

}  // namespace nightcity
