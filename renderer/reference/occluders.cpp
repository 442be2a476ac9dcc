// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/occluders.h"

#include <algorithm>

#include "reference/hull_region.h"

namespace nightcity {

Occluders::Occluders(const FlatScene& scene) : faces_(scene), tree_(faces_.bounds()) {
    if (scene.ground) {
        groundHeight_ = double(scene.ground->height);
    }
}

std::vector<std::uint32_t> Occluders::between(std::span<const glm::dvec3> source,
                                              glm::dvec3 begin, glm::dvec3 end) const {
    const HullRegion region(source, begin, end);
    std::vector<std::uint32_t> faces;
    tree_.visitWhere([&](const Bounds& box) { return region.mayTouch(box); },
                      [&](std::uint32_t index) {
                          if (region.mayTouch(face(index))) {
                              faces.push_back(index);
                          }
                      });
    std::sort(faces.begin(), faces.end());
    return faces;
}

}  // namespace nightcity
