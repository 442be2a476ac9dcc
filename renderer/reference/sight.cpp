// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/sight.h"

#include "reference/shadow_intervals.h"

namespace nightcity {

std::vector<RayPart> seenFrom(glm::dvec3 point, const Hiders& hiders, const Ray& ray,
                              const RayPart& part) {
    const ViewTriangle view(point, ray.at(part.begin), ray.at(part.end));
    std::vector<Interval> shadows;
    for (std::size_t i = 0; i < hiders.size(); ++i) {
        if (!view.isFlat()) {
            const Interval hidden = shadow(view, hiders[i]);
            if (!hidden.isEmpty()) {
                shadows.push_back(hidden);
            }
        } else if (blocksLine(view, hiders[i])) {
            return {};
        }
    }
    const double length = part.end - part.begin;
    std::vector<RayPart> seen;
    for (const Interval& open : unshadowed(shadows)) {
        seen.push_back({part.begin + open.begin * length,
                        open.end == 1 ? part.end : part.begin + open.end * length});
    }
    return seen;
}

}  // namespace nightcity
