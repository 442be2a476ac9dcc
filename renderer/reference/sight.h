// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which part of a line a window sees, with what stands between the two found once
// for all of the window's points.
#pragma once

#include <cstdint>
#include <vector>

#include "reference/emitters.h"
#include "reference/occluders.h"
#include "reference/ray.h"
#include "reference/shadow_intervals.h"

namespace nightcity {

// A part of a ray, m along it.
struct RayPart {
    double begin = 0;
    double end = 0;
};

class Sight {
public:
    // From points within `radius` (m) of `centre` to `part` of the ray.
    Sight(const Occluders& occluders, glm::dvec3 centre, double radius, const Ray& ray,
          const RayPart& part);

    // What a point of the source sees of the part, in order.
    std::vector<RayPart> seenFrom(glm::dvec3 point) const;

    // Leaves out what no point of the hull of the corners sees for certain: where one
    // convex face hides a stretch from each corner it hides it from the whole hull,
    // because every way between the two crosses the face within the hull of the ways
    // between the corners. Returns false where nothing is left.
    bool trim(const std::vector<glm::dvec3>& corners);

    // Whether anything may hide any of the part from any of the points.
    bool hasShadows() const { return !faces_.empty(); }

private:
    glm::dvec3 begin() const { return ray_.at(part_.begin); }
    glm::dvec3 end() const { return ray_.at(part_.end); }
    RayPart partOf(const Interval& fractions) const;

    const Occluders& occluders_;
    const Ray& ray_;
    RayPart part_;
    std::vector<std::uint32_t> faces_;
};

}  // namespace nightcity
