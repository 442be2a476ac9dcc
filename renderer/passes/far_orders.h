// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Light of the second order of scattering and on, added to the nodes of the far field
// (shaders/shared/order_cells.h): gathered anew for every state of the windows, from what a bake of
// the first order left in the nodes. Rays start at places and go in directions that depend on the
// layout of the bricks alone.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "order_cells.h"
#include "frame.h"
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/compute_pipeline.h"
#include "gpu/readable_buffer.h"
#include "passes/brick_batches.h"
#include "settings.h"

namespace nightcity {

// Of the scene on the device.
struct SceneAddresses {
    VkDeviceAddress table = 0;  // SceneTable
    VkAccelerationStructureKHR structure = VK_NULL_HANDLE;
};

// What it takes on the device, bytes.
std::uint64_t farOrderBytes(std::uint64_t bricks, Surfaces surfaces);

class FarOrders {
public:
    FarOrders(gpu::Device& device, gpu::Commands& commands)
        : device_(device), commands_(commands) {}

    // `model`: of its emitter, visibility and surfaces.
    void syncGeometry(std::uint64_t bricks, const Model& model);
    void clear();

    // One bake of the first order, in whose nodes the others shall be.
    struct Bake {
        float nearRadius;  // m
        std::uint32_t windows;
        float strongest;  // W, of one channel of one window
        VkDeviceAddress field, bake;  // FarFieldTable and FarBakeTable
        SceneAddresses scene;
    };
    // Adds the times of its passes to `times`.
    void add(const Bake& bake, const BakeProgress& progress, BakeShare share,
             std::vector<PassTime>& times);

    std::uint64_t bytes() const;

private:
    // Those that were gathered so far.
    struct Orders {
        std::uint32_t number = 1;  // of the last
        double last = 0, all = 0;  // its energy, and of all
        double tail = 0;           // of those that follow, as a share of the last
    };

    uvec2 allocate(const char* name, std::uint64_t bytes);
    void makePipelines();
    bool endsWith(std::uint32_t order, Orders& orders);
    double energyOf(const gpu::ReadableBuffer& cells);
    void writeTable(const Bake& bake, const Orders& orders);

    gpu::Device& device_;
    gpu::Commands& commands_;
    Model model_;
    bool hasPipelines_ = false;
    std::uint32_t bricks_ = 0;
    gpu::ComputePipeline near_, source_, lookOut_, gatherFirst_, gatherNext_, gatherAll_, add_;
    FarOrdersTable contents_{};
    std::vector<gpu::Buffer> arrays_;
    gpu::Buffer table_, nearEnergy_;
    gpu::ReadableBuffer hazeVolume_, first_;
    std::array<gpu::ReadableBuffer, 2> orders_;  // even, odd
};

}  // namespace nightcity
