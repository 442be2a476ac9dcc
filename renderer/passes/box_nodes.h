// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Trees over boxes as the shaders walk them (dispatch.h). No Vulkan.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "dispatch.h"
#include "scene/box_tree.h"

namespace nightcity {

// The root first; empty without boxes. While it is built it takes 28 bytes a box besides the nodes,
// at most two a box: `boundsOf` is asked twice for each.
std::vector<BoxNode> buildBoxNodes(std::size_t count,
                                   const std::function<Bounds(std::uint32_t)>& boundsOf);
std::vector<BoxNode> buildBoxNodes(std::span<const Bounds> boxes);

}  // namespace nightcity
