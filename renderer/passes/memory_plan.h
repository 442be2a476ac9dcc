// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What the device will hold at most while a frame is baked and rendered, foretold before any of
// it is made.
#pragma once

#include <cstdint>

#include "gpu/device.h"
#include "passes/far_field_grid.h"
#include "scene/flat_scene.h"
#include "settings.h"

namespace nightcity {

struct MemoryPlan {
    std::uint64_t scene = 0;       // bytes: geometry, windows, media and the trees over them
    std::uint64_t structures = 0;  // acceleration structures and what builds them
    std::uint64_t lights = 0;      // light lists and trees
    std::uint64_t field = 0;       // of Method::field: bricks, bake and near windows
    std::uint64_t frame = 0;       // images and records of the rays

    std::uint64_t bytes() const { return scene + structures + lights + field + frame; }
};

// Not less than what is used, and seldom more than half as much again: what depends on the shapes
// of facades and faces is bounded, the rest is counted. `field`: of Method::field with media.
MemoryPlan planMemory(gpu::Device& device, const FlatScene& scene, const RenderProduct& product,
                      const RenderSettings& settings, const FarFieldSettings* field);

// Throws DeviceError with the figures where the plan passes the budget (bytes).
void requireMemory(const MemoryPlan& plan, std::uint64_t budget, const std::string& device);

}  // namespace nightcity
