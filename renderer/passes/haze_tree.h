// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Haze in the order in which a ray meets it, for shaders/haze_walk.glsl. No Vulkan.
#pragma once

#include <span>
#include <vector>

#include "dispatch.h"
#include "far_field.h"

namespace nightcity {

// The root first; cells are cut at faces of the media until each holds at most one of them.
// Where media overlap, the first of them counts. Empty without media.
std::vector<HazeNode> buildHazeTree(std::span<const FarMedium> media);

}  // namespace nightcity
