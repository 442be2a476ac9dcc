// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/sight.h"

#include <algorithm>

namespace nightcity {

Sight::Sight(const Occluders& occluders, glm::dvec3 centre, double radius, const Ray& ray,
             const RayPart& part)
    : occluders_(occluders),
      ray_(ray),
      part_(part),
      faces_(occluders.between(centre, radius, begin(), end())) {}

RayPart Sight::partOf(const Interval& fractions) const {
    const double length = part_.end - part_.begin;
    return {part_.begin + fractions.begin * length,
            fractions.end == 1 ? part_.end : part_.begin + fractions.end * length};
}

std::vector<RayPart> Sight::seenFrom(glm::dvec3 point) const {
    if (occluders_.groundBetween(point, 0.5 * (begin() + end()))) {
        return {};
    }
    const ViewTriangle view(point, begin(), end());
    std::vector<Interval> shadows;
    for (const std::uint32_t index : faces_) {
        const auto face = occluders_.face(index);
        if (!view.isFlat()) {
            const Interval hidden = shadow(view, face);
            if (!hidden.isEmpty()) {
                shadows.push_back(hidden);
            }
        } else if (blocksLine(view, face)) {
            return {};
        }
    }
    std::vector<RayPart> seen;
    for (const Interval& open : unshadowed(shadows)) {
        seen.push_back(partOf(open));
    }
    return seen;
}

bool Sight::trim(const std::vector<glm::dvec3>& corners) {
    std::vector<ViewTriangle> views;
    for (const glm::dvec3 corner : corners) {
        views.emplace_back(corner, begin(), end());
        if (views.back().isFlat()) {
            return true;
        }
    }
    std::vector<Interval> shadows;
    for (const std::uint32_t index : faces_) {
        Interval common{0, 1};
        for (const ViewTriangle& view : views) {
            const Interval hidden = shadow(view, occluders_.face(index));
            common = {std::max(common.begin, hidden.begin), std::min(common.end, hidden.end)};
            if (common.isEmpty()) {
                break;
            }
        }
        if (!common.isEmpty()) {
            shadows.push_back(common);
        }
    }
    const std::vector<Interval> open = unshadowed(shadows);
    if (open.empty()) {
        return false;
    }
    part_ = partOf({open.front().begin, open.back().end});
    return true;
}

}  // namespace nightcity
