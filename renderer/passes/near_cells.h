// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which windows have near parts that rays integrate: those that reach a brick of the far field that
// does not hold them itself (FarFieldTable::blurredScale). No Vulkan.
#pragma once

#include <vector>

#include "passes/far_layout.h"

namespace nightcity {

class NearCells {
public:
    // `radius`: m, the near radius.
    NearCells(const FarLayout& layout, float radius);

    // Never false for a window with such a near part.
    bool reaches(vec3 centre) const;

private:
    void widen(int axis, int cells);

    vec3 origin_{0};
    float cellSide_ = 1;
    glm::ivec3 counts_{0};
    std::vector<bool> cells_;  // x fastest
};

}  // namespace nightcity
