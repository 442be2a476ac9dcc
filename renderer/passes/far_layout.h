// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the bricks of the far field lie and which media each overlaps. No Vulkan.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "far_field.h"

namespace nightcity {

struct FarLayout {
    vec3 origin{0};      // m
    float brickSide = 1; // m
    uvec3 counts{0};     // of lattice cells; 0 without media
    std::vector<uint> index;       // as FarFieldTable has them
    std::vector<FarBrick> bricks;
    std::vector<uvec3> cells;      // of the bricks
    std::vector<uint> mediumList;
    std::uint64_t nodes = 0;
};

// `spacing`: of the nodes, m. Nodes lie half a spacing off the lower corner of the media, so
// that no wall on a street grid runs through them. Throws DeviceError, with the figure, where the
// nodes would take more than `memoryBytes`.
FarLayout layoutFarField(std::span<const FarMedium> media, float spacing,
                         std::uint64_t memoryBytes);

// What a node takes on the device: sums and halves, bytes.
inline constexpr std::uint64_t kFarNodeBytes = 20;

}  // namespace nightcity
