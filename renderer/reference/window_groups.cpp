// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/window_groups.h"

#include "scene/box_tree.h"

namespace nightcity {

namespace {

constexpr double kLargestSide = 9;        // m; larger groups have more in their way
constexpr double kLargestThickness = 0.01;  // m
constexpr double kSameNormal = 1e-5;

// Bounds along a window's own axes, as long as windows fit in.
class GrowingGroup {
public:
    GrowingGroup(const LitWindow& first, Emitter emitter) : emitter_(emitter), normal_(first.normal) {
        if (!first.sphere) {
            axes_[0] = glm::normalize(first.halfU);
            axes_[1] = glm::cross(normal_, axes_[0]);
            axes_[2] = normal_;
        }
        add(first);
    }

    // Whether it fitted.
    bool tryToAdd(const LitWindow& window) {
        if (window.sphere ||
            glm::length(window.normal - normal_) > kSameNormal) {
            return false;
        }
        const Bounds before = bounds_;
        add(window);
        const glm::dvec3 size = bounds_.hi - bounds_.lo;
        if (size.x > kLargestSide || size.y > kLargestSide || size.z > kLargestThickness) {
            bounds_ = before;
            return false;
        }
        return true;
    }

    WindowGroup finish() const {
        WindowGroup group;
        constexpr int kOrder[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        for (std::size_t i = 0; i < 8; ++i) {
            const auto [u, v] = kOrder[i % 4];
            const glm::dvec3 at(u ? bounds_.hi.x : bounds_.lo.x, v ? bounds_.hi.y : bounds_.lo.y,
                                i < 4 ? bounds_.lo.z : bounds_.hi.z);
            group.corner[i] = at.x * axes_[0] + at.y * axes_[1] + at.z * axes_[2];
        }
        group.normal = normal_;
        group.lowest = bounds_.lo.z;
        group.highest = bounds_.hi.z;
        return group;
    }

private:
    void add(const LitWindow& window) {
        const auto addPoint = [&](glm::dvec3 point) {
            bounds_.add({glm::dot(axes_[0], point), glm::dot(axes_[1], point),
                         glm::dot(axes_[2], point)});
        };
        if (!window.isPane(emitter_)) {
            addPoint(window.centre);
            return;
        }
        for (const glm::dvec2 uv : {glm::dvec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
            addPoint(window.at(uv));
        }
    }

    Emitter emitter_;
    glm::dvec3 normal_;
    glm::dvec3 axes_[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    Bounds bounds_;
};

}  // namespace

WindowGroups::WindowGroups(std::span<const LitWindow> windows, Emitter emitter)
    : groupOf_(windows.size()) {
    std::size_t next = 0;
    while (next < windows.size()) {
        GrowingGroup group(windows[next], emitter);
        do {
            groupOf_[next++] = std::uint32_t(groups_.size());
        } while (next < windows.size() && group.tryToAdd(windows[next]));
        groups_.push_back(group.finish());
    }
}

}  // namespace nightcity
