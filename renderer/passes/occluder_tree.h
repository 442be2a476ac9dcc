// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The opaque convex faces as the shaders read them (dispatch.h, shaders/occluders.glsl):
// a tree of their bounds, their planes, their corners. No Vulkan.
#pragma once

#include <cstdint>
#include <vector>

#include "dispatch.h"
#include "scene/flat_scene.h"

namespace nightcity {

struct OccluderTree {
    std::vector<BoxNode> nodes;  // the root first; empty without faces
    std::vector<OccluderFace> faces;
    std::vector<vec3> corners;   // m
    std::vector<std::uint32_t> faceOfTriangle;
};

OccluderTree buildOccluderTree(const FlatScene& scene);

}  // namespace nightcity
