// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The binary tree over the lit windows from which the path tracer draws them and by
// which gauss leaves them out
// (dispatch.h, shaders/light_tree.glsl). No Vulkan.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dispatch.h"
#include "scene/flat_scene.h"
#include "settings.h"

namespace nightcity {

struct LightTree {
    std::vector<LightNode> nodes;        // the root first; empty without lit windows
    std::vector<std::uint32_t> trails;   // one a window: bit i set where the way to it takes the
                                         // second child at level i; 0 for unlit windows
};

// `windowOn`: one byte a window. At most 31 levels for up to a hundred million windows: halves
// by number, after a first parting by the direction in which windows face.
LightTree buildLightTree(const FlatScene& scene, std::span<const std::uint8_t> windowOn,
                         Emitter emitter);

}  // namespace nightcity
