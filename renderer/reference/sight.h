// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which part of a ray a point sees.
#pragma once

#include <vector>

#include "reference/hiders.h"
#include "reference/ray.h"

namespace nightcity {

// What a point sees of a part of a ray past the hiders, in order.
std::vector<RayPart> seenFrom(glm::dvec3 point, const Hiders& hiders, const Ray& ray,
                              const RayPart& part);

}  // namespace nightcity
