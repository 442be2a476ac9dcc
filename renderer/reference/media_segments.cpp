// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/media_segments.h"

#include <algorithm>
#include <limits>

namespace nightcity {

namespace {

std::vector<Bounds> boundsOf(const FlatScene& scene) {
    std::vector<Bounds> bounds;
    for (const MediaBox& box : scene.mediaBoxes) {
        bounds.push_back({glm::dvec3(box.lo), glm::dvec3(box.hi)});
    }
    return bounds;
}

// Whether a ray that runs parallel to some faces stays below the upper ones, which
// are not part of the box. slabs() has seen to the rest.
bool belowUpperFaces(const Bounds& box, const Ray& ray) {
    for (int axis = 0; axis < 3; ++axis) {
        if (ray.direction[axis] == 0 && !(ray.origin[axis] < box.hi[axis])) {
            return false;
        }
    }
    return true;
}

}  // namespace

MediaSegments::MediaSegments(const FlatScene& scene) : scene_(scene), tree_(boundsOf(scene)) {}

std::vector<Segment> MediaSegments::along(const Ray& ray, double farthest) const {
    std::vector<Segment> segments;
    const auto limit = [&] { return farthest; };
    tree_.visitAlong(ray.origin, ray.direction, limit, [&](std::uint32_t index) {
        const Bounds& box = tree_.box(index);
        const auto [enter, leave] = slabs(box, ray.origin, ray.direction);
        const double end = std::min(leave, farthest);
        if (enter < end && belowUpperFaces(box, ray)) {
            segments.push_back({index, enter, end});
        }
    });
    std::sort(segments.begin(), segments.end(), [](const Segment& a, const Segment& b) {
        return a.begin != b.begin ? a.begin < b.begin : a.box < b.box;
    });
    return segments;
}

}  // namespace nightcity
