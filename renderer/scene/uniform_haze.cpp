// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/uniform_haze.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "scene/box_tree.h"

namespace nightcity {
namespace {

constexpr double kRounding = 1e-9;  // share of a volume
constexpr double kTouching = 1e-4;  // m, of neighbours that share a face

double volumeOf(const Bounds& box) {
    const glm::dvec3 size = glm::max(box.hi - box.lo, glm::dvec3(0));
    return size.x * size.y * size.z;
}

// The bounds of a building whose twelve triangles lie on them and cover them.
std::optional<Bounds> boxOf(const FlatScene& scene, const Building& building) {
    const auto triangles = scene.triangles.subspan(building.firstTriangle, building.triangleCount);
    Bounds bounds;
    for (const Triangle& triangle : triangles) {
        for (int k = 0; k < 3; ++k) {
            bounds.add(glm::dvec3(scene.positions[triangle.vertex[k]]));
        }
    }
    double covered = 0;
    for (const Triangle& triangle : triangles) {
        const glm::dvec3 a(scene.positions[triangle.vertex.x]);
        const glm::dvec3 b(scene.positions[triangle.vertex.y]);
        const glm::dvec3 c(scene.positions[triangle.vertex.z]);
        bool lies = false;
        for (int axis = 0; axis < 3; ++axis) {
            const bool level = a[axis] == b[axis] && b[axis] == c[axis];
            lies |= level && (a[axis] == bounds.lo[axis] || a[axis] == bounds.hi[axis]);
        }
        if (!lies) {
            return std::nullopt;
        }
        covered += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    if (triangles.size() != 12) {
        return std::nullopt;
    }
    const glm::dvec3 size = bounds.hi - bounds.lo;
    const double surface = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
    return covered >= surface * (1 - kRounding) ? std::optional(bounds) : std::nullopt;
}

// Whether a box shares more than a face with any of the tree.
bool overlapsAny(const BoxTree& tree, const Bounds& box, std::optional<std::uint32_t> itself) {
    bool overlaps = false;
    tree.visitTouching({box.lo + kTouching, box.hi - kTouching},
                       [&](std::uint32_t index) { overlaps |= index != itself; });
    return overlaps;
}

// The media boxes, and the buildings that stand in none of them.
std::vector<Bounds> filledBoxes(const FlatScene& scene) {
    std::vector<Bounds> boxes;
    for (const MediaBox& box : scene.mediaBoxes) {
        boxes.push_back({glm::dvec3(box.lo), glm::dvec3(box.hi)});
    }
    const BoxTree media(boxes);
    for (const Building& building : scene.buildings) {
        const auto box = boxOf(scene, building);
        if (box && !overlapsAny(media, *box, std::nullopt)) {
            boxes.push_back(*box);
        }
    }
    return boxes;
}

}  // namespace

bool isHazeUniform(const FlatScene& scene) {
    const auto differs = [&](const MediaBox& box) {
        return box.extinction != scene.mediaBoxes.front().extinction;
    };
    if (scene.mediaBoxes.empty() ||
        std::any_of(scene.mediaBoxes.begin(), scene.mediaBoxes.end(), differs)) {
        return false;
    }
    const std::vector<Bounds> boxes = filledBoxes(scene);
    const BoxTree tree(boxes);
    Bounds all;
    double filled = 0;
    for (const MediaBox& box : scene.mediaBoxes) {
        all.add(glm::dvec3(box.lo));
        all.add(glm::dvec3(box.hi));
    }
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        if (overlapsAny(tree, boxes[i], i)) {
            return false;
        }
        filled += volumeOf({glm::max(boxes[i].lo, all.lo), glm::min(boxes[i].hi, all.hi)});
    }
    for (const Window& window : scene.windows) {
        const glm::dvec3 reach = glm::abs(glm::dvec3(window.halfU)) + glm::abs(glm::dvec3(window.halfV));
        Bounds with = all;
        with.add(glm::dvec3(window.centre) - reach);
        with.add(glm::dvec3(window.centre) + reach);
        if (with.lo != all.lo || with.hi != all.hi) {
            return false;
        }
    }
    return filled >= volumeOf(all) * (1 - kRounding);
}

}  // namespace nightcity
