// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What stands between a group of windows and a ray, found once for all of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "reference/hiders.h"
#include "reference/occluders.h"
#include "reference/ray.h"
#include "reference/window_groups.h"

namespace nightcity {

// Looks along a ray: what lies on one straight way to it lies in one direction.
class AlongRay {
public:
    explicit AlongRay(const Ray& ray);

    const Ray& ray() const { return ray_; }
    // A point as it is seen along the ray, which is the origin. m
    glm::dvec2 across(glm::dvec3 point) const {
        return {glm::dot(point - ray_.origin, right_), glm::dot(point - ray_.origin, up_)};
    }

private:
    Ray ray_;
    glm::dvec3 right_, up_;
};

// The directions, seen along a ray, in which something lies.
class Wedge {
public:
    explicit Wedge(std::span<const glm::dvec2> points);

    // Whether nothing with these corners lies in the wedge; false in doubt.
    bool misses(std::span<const glm::dvec2> corners) const;

private:
    glm::dvec2 first_, last_;  // counterclockwise, less than half a turn
    bool all_ = false;
};

class GroupSight {
public:
    // Hidden: nothing between is looked for. `blockers` are faces that hid whole
    // groups from this ray, the last one first; they are tried first and kept up.
    GroupSight(const Occluders& occluders, const WindowGroup& group, Emitter emitter,
               const AlongRay& along, const RayPart& part, std::vector<std::uint32_t>& blockers);

    // Whether one convex face hides all of the group from all of the part.
    bool isHidden() const { return hidden_; }

    // Of a window of the group.
    Hiders hidersOf(const LitWindow& window, Emitter emitter) const;

private:
    bool isBlockedBy(std::span<const glm::dvec3> face) const;
    void findFaces(Emitter emitter);

    const Occluders& occluders_;
    const WindowGroup& group_;
    const AlongRay& along_;
    glm::dvec3 begin_, end_;
    bool hidden_ = false;
    std::vector<std::uint32_t> faces_;
    std::vector<glm::dvec2> across_;           // their corners, seen along the ray
    std::vector<std::uint32_t> firstAcross_;   // into across_, one more than faces_
};

}  // namespace nightcity
