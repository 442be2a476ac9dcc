// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/near_panes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "passes/occluder_tree.h"
#include "scene/box_tree.h"
#include "transport/near_window.h"

namespace nightcity {
namespace {

NearPane nearPane(const Window& window) {
    NearPane pane{};
    pane.centre = window.centre;
    pane.halfU = glm::length(window.halfU);
    pane.flags = window.flags;
    if ((window.flags & kWindowSphere) != 0) {
        pane.uAxis = {1, 0, 0};
        pane.vAxis = {0, 1, 0};
        pane.radiance = window.colour * float(window.power / (4 * std::numbers::pi));
        return pane;
    }
    pane.halfV = glm::length(window.halfV);
    pane.uAxis = window.halfU / pane.halfU;
    pane.vAxis = window.halfV / pane.halfV;
    const double area = 4.0 * pane.halfU * pane.halfV;
    pane.closeBy = float(std::hypot(pane.halfU, pane.halfV) + 1.01 * kNearCutSides * std::sqrt(area));
    pane.radiance = window.colour * float(window.power / (std::numbers::pi * area));
    return pane;
}

// Of the part of the ball about a pane that lies before it. Along an axis it ends at the ball
// where the normal points that way, else at the rim of the pane's plane.
Bounds reachOf(const NearPane& pane, double radius) {
    const glm::dvec3 normal = glm::cross(glm::dvec3(pane.uAxis), glm::dvec3(pane.vAxis));
    const bool isBall = (pane.flags & kWindowSphere) != 0;
    Bounds bounds;
    for (int axis = 0; axis < 3; ++axis) {
        const double rim = radius * std::sqrt(std::max(0.0, 1 - normal[axis] * normal[axis]));
        bounds.lo[axis] = pane.centre[axis] - (isBall || normal[axis] <= 0 ? radius : rim);
        bounds.hi[axis] = pane.centre[axis] + (isBall || normal[axis] >= 0 ? radius : rim);
    }
    return bounds;
}

}  // namespace

NearKinds NearPanes::kinds(double tolerance) const {
    // From 0.5 % on a ray that does not graze needs no cuts (transport/near_window.h).
    return {hasSpheres, tolerance < 0.005, opticalHalf <= tolerance};
}

NearPanes buildNearPanes(const FlatScene& scene, float radius) {
    NearPanes near;
    std::vector<Bounds> bounds;
    double longest = 0;
    for (const Window& window : scene.windows) {
        const NearPane& pane = near.panes.emplace_back(nearPane(window));
        near.hasSpheres |= (window.flags & kWindowSphere) != 0;
        longest = std::max(longest, std::hypot(double(pane.halfU), double(pane.halfV)));
        bounds.push_back(reachOf(pane, radius));
    }
    for (const MediaBox& box : scene.mediaBoxes) {
        near.opticalHalf = std::max(near.opticalHalf, longest * double(box.extinction));
    }
    if (!bounds.empty()) {
        near.tree = packBoxTree(BoxTree(std::move(bounds)));
    }
    return near;
}

}  // namespace nightcity
