// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// How high what is opaque reaches, seen from above, on a grid of squares: what large bricks of the
// far field ask for sight over the roofs (shaders/far_roofs.glsl). No Vulkan.
#pragma once

#include <cstdint>
#include <vector>

#include "far_bake.h"
#include "scene/convex_faces.h"

namespace nightcity {

struct HeightMap {
    vec2 origin{0};  // m, lower corner
    float cellSide = 1;  // m
    uvec2 counts{1};     // of cells
    std::vector<float> heights;  // m, of the highest such face over a cell's centre, else kNoRoof;
                                 // x fastest
};

// What a map takes on the device, most.
inline constexpr std::uint64_t kHeightMapBytes = 40'000'000;

// Over all faces that look upward. Cells are `cellSide` m or as much larger as keeps the map within
// kHeightMapBytes. Without such faces it is one cell of kNoRoof.
HeightMap buildHeightMap(const ConvexFaces& faces, float cellSide);

}  // namespace nightcity
