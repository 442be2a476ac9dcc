// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the bricks of the far field lie, how large each is, and which media it overlaps.
// No Vulkan.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "far_field.h"
#include "passes/far_alignment.h"

namespace nightcity {

// How fine the field is where: nodes are nodes.spacing apart up to a distance from the eyes, and
// beyond it farther in proportion to the distance. That distance is as large as `mostBricks`
// and the memory allow.
struct FarDetail {
    LatticeAlignment nodes;          // of the smallest bricks
    std::span<const vec3> eyes;      // m, along the way of the camera; none: so everywhere
    std::uint64_t mostBricks = ~0u;  // more only where the smallest such distance asks for more
    std::uint64_t memoryBytes = ~std::uint64_t{0};  // of all bricks, never more
};

struct FarLayout {
    vec3 origin{0};      // m
    float cellSide = 1;  // m
    uvec3 counts{0};     // of lattice cells; 0 without media
    std::vector<uint> index;       // as FarFieldTable has them
    std::vector<FarBrick> bricks;  // neighbours in space mostly are neighbours here
    std::vector<uint> mediumList;
    std::uint64_t nodes() const { return std::uint64_t{bricks.size()} * kBrickNodes; }
    // Larger ones than the smallest: their nodes are as far apart as their number allows, not as
    // the tolerance asks.
    bool hasLargeBricks() const;
};

// From which scale on bricks hold the near parts too, blurred, for nodes that far apart in those of
// scale 0: where they are farther apart than 1.4 near radii. `nearRadius`, `spacing`: m.
unsigned blurredScale(float nearRadius, float spacing);

// Throws DeviceError, with the figure, where the field would take more than the memory.
FarLayout layoutFarField(std::span<const FarMedium> media, const FarDetail& detail);

// What a node takes on the device: sums and halves, bytes.
inline constexpr std::uint64_t kFarNodeBytes = 20;

}  // namespace nightcity
