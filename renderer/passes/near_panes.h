// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The windows as their near parts are integrated, and a tree over the places that these reach
// (shaders/shared/glow.h). Does not depend on which windows are on. No Vulkan.
#pragma once

#include <vector>

#include "dispatch.h"
#include "glow.h"
#include "scene/flat_scene.h"

namespace nightcity {

struct NearPanes {
    std::vector<NearPane> panes;  // one a window
    std::vector<BoxNode> tree;    // over the part of each one's ball of the radius before it
};

// `radius`: m, the near radius.
NearPanes buildNearPanes(const FlatScene& scene, float radius);

}  // namespace nightcity
