// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/far_orders.h"

#include <algorithm>
#include <cmath>

#include "far_gather_spirv.h"
#include "far_higher_spirv.h"
#include "far_near_spirv.h"
#include "far_order_nodes_spirv.h"
#include "far_order_places_spirv.h"
#include "far_source_spirv.h"
#include "passes/gpu_scene.h"
#include "passes/pass_pipelines.h"

namespace nightcity {
namespace {

static_assert(sizeof(FarOrdersTable) == 13 * 8 + 16);

// Rays, about, of all places of cells for an order, and of all nodes.
constexpr double kCellRays = 1.2e6, kNodeRays = 5e6;
constexpr double kLeastRays = 16, kMostRays = 128;  // of one
constexpr std::uint32_t kLitRays = 3;  // times as many of a node where each meets a random window too
// Orders end where all that follow, if each brings the same share of the one before, bring less
// than this of all; or at the last, in thick haze that loses nothing.
constexpr double kLargestTail = 0.01;
constexpr std::uint32_t kLastOrder = 48;
constexpr double kLargestRatio = 0.98;
// Of all that higher orders take, when a pass is done.
constexpr double kNearEnd = 0.1, kSourceEnd = 0.15, kCellsEnd = 0.5, kNodesEnd = 0.98;

std::uint32_t raysOf(double rays, double points) {
    return static_cast<std::uint32_t>(std::clamp(rays / points, kLeastRays, kMostRays));
}

// Rays that windows send through what the nodes do not hold of their light, about.
constexpr double kNearRays = 2e6;
constexpr double kLeastNearRays = 4, kMostNearRays = 64;  // of a window
// Of what the strongest window brings: so many as 4096 of them find room in the integers of a cell.
constexpr float kEnergyUnit = 1.0f / (1 << 20);

std::uint32_t raysOfWindow(std::uint32_t windows) {
    return static_cast<std::uint32_t>(
        std::clamp(kNearRays / double(std::max(windows, 1u)), kLeastNearRays, kMostNearRays));
}

}  // namespace

std::uint64_t farOrderBytes(std::uint64_t bricks, Surfaces surfaces) {
    const std::uint64_t sides = surfaces == Surfaces::lit ? kCellSides : 0;
    return bricks * ((kOrderNodes + kPlaceThreads) * sizeof(vec4) +
                     kOrderCells * ((5 + 3 * sides) * sizeof(vec3) + 4)) +
           sizeof(FarOrdersTable);
}

void FarOrders::clear() {
    bricks_ = 0;
    contents_ = {};
    arrays_.clear();
    table_ = {};
    nearEnergy_ = {};
    hazeVolume_ = {};
    first_ = {};
    orders_ = {};
}

uvec2 FarOrders::allocate(const char* name, std::uint64_t bytes) {
    arrays_.emplace_back(device_, name, bytes, gpu::MemoryKind::device);
    return addressWords(arrays_.back().address());
}

void FarOrders::syncGeometry(std::uint64_t bricks, const Model& model) {
    clear();
    if (!hasPipelines_ || model_ != model) {
        model_ = model;
        makePipelines();
    }
    if (bricks == 0) {
        return;
    }
    bricks_ = static_cast<std::uint32_t>(bricks);
    const std::uint64_t cells = bricks * kOrderCells;
    table_ = {device_, "far orders table", sizeof(FarOrdersTable), gpu::MemoryKind::device};
    nearEnergy_ = {device_, "far near energy", cells * sizeof(uvec3), gpu::MemoryKind::device};
    contents_.nearEnergy = addressWords(nearEnergy_.address());
    contents_.places = allocate("far order places", bricks * kPlaceThreads * sizeof(vec4));
    contents_.higher = allocate("far higher orders", cells * sizeof(vec3));
    contents_.nodes = allocate("far order nodes", bricks * kOrderNodes * sizeof(vec4));
    if (model_.surfaces == Surfaces::lit) {
        for (uvec2* sides : {&contents_.evenSides, &contents_.oddSides, &contents_.higherSides}) {
            *sides = allocate("far order sides", cells * kCellSides * sizeof(vec3));
        }
    }
    const auto makeReadable = [&](const char* name, std::uint64_t bytes, uvec2& address) {
        gpu::ReadableBuffer buffer(device_, name, bytes);
        address = addressWords(buffer.buffer().address());
        return buffer;
    };
    hazeVolume_ = makeReadable("far haze volume", cells * 4, contents_.hazeVolume);
    first_ = makeReadable("far first order", cells * sizeof(vec3), contents_.first);
    orders_[0] = makeReadable("far even orders", cells * sizeof(vec3), contents_.even);
    orders_[1] = makeReadable("far odd orders", cells * sizeof(vec3), contents_.odd);
}

void FarOrders::makePipelines() {
    source_ = makePipeline(device_, "far source", kFarSourceSpirv, {});
    lookOut_ = makePipeline(device_, "far order places", kFarOrderPlacesSpirv, {});
    add_ = makePipeline(device_, "far higher", kFarHigherSpirv, {});
    std::vector<std::uint32_t> constants = modelConstants(model_, true);
    const auto makeRays = [&](const char* name, std::span<const std::uint32_t> spirv,
                              std::uint32_t gather) {
        constants.resize(NIGHTCITY_CONSTANT_GATHER);
        constants.push_back(gather);
        return makePipeline(device_, name, spirv, {kStructureBinding}, constants);
    };
    near_ = makeRays("far near", kFarNearSpirv, kGatherFirst);
    gatherFirst_ = makeRays("far gather", kFarGatherSpirv, kGatherFirst);
    gatherNext_ = makeRays("far gather on", kFarGatherSpirv, kGatherNext);
    gatherAll_ = makeRays("far order nodes", kFarOrderNodesSpirv, kGatherAll);
    hasPipelines_ = true;
}

void FarOrders::add(const Bake& bake, const BakeProgress& progress, BakeShare share,
                    std::vector<PassTime>& times) {
    if (bricks_ == 0) {
        return;
    }
    for (gpu::ComputePipeline* pipeline : {&near_, &gatherFirst_, &gatherNext_, &gatherAll_}) {
        pipeline->bindAccelerationStructure(NIGHTCITY_BINDING_STRUCTURE, bake.scene.structure);
    }
    writeTable(bake, {});
    PushConstants push{};
    push.scene = addressWords(bake.scene.table);
    push.frame = addressWords(table_.address());
    BakeShare part{share.from, share.from};
    // `end`: of the share, where the pass is done.
    const auto run = [&](const char* name, const gpu::ComputePipeline& pipeline,
                         std::uint64_t groups, double end) {
        part = {part.to, share.from + end * (share.to - share.from)};
        forBatches(static_cast<std::uint32_t>(groups), progress, part, [&](BrickBatch batch) {
            push.firstPixel = batch.first;
            push.pixelCount = batch.count;
            addPassTime(times, name, commands_.run(name, [&](VkCommandBuffer commands) {
                pipeline.dispatch(commands, &push, batch.count);
                gpu::computeBarrier(commands);
            }));
            return batch.count;
        });
    };
    commands_.run("clearing near energy", [&](VkCommandBuffer commands) {
        vkCmdFillBuffer(commands, nearEnergy_.get(), 0, VK_WHOLE_SIZE, 0);
        gpu::computeBarrier(commands);
    });
    push.sampleIndex = raysOfWindow(bake.windows);
    const std::uint64_t nearRays = std::uint64_t{bake.windows} * push.sampleIndex;
    run("far near", near_, (nearRays + kGroupSize - 1) / kGroupSize, kNearEnd);
    run("far source", source_, bricks_, kSourceEnd);
    push.sampleIndex = raysOf(kCellRays, double(bricks_) * kPlaceThreads);
    Orders orders;
    orders.last = energyOf(first_);
    orders.all = orders.last;
    bool isLast = false;
    for (push.round = 2; push.round <= kLastOrder && !isLast; ++push.round) {
        const bool isSecond = push.round == 2;
        run(isSecond ? "far gather" : "far gather on", isSecond ? gatherFirst_ : gatherNext_,
            bricks_, kCellsEnd - (kCellsEnd - kSourceEnd) / push.round);
        orders.number = push.round;
        isLast = endsWith(push.round, orders);
    }
    writeTable(bake, orders);
    run("far order places", lookOut_, bricks_, kCellsEnd);
    const std::uint32_t more = model_.surfaces == Surfaces::lit ? kLitRays : 1;
    push.sampleIndex = more * raysOf(kNodeRays, double(bricks_) * kOrderNodes);
    run("far order nodes", gatherAll_, bricks_, kNodesEnd);
    run("far higher", add_, bricks_, 1);
}

// Whether all orders that follow one are little. They count as a geometric series. Haze that no
// window lights has a second order nevertheless, where surfaces reflect into it.
bool FarOrders::endsWith(std::uint32_t order, Orders& orders) {
    const gpu::ReadableBuffer& cells = orders_[order % 2];
    const double energy = energyOf(cells);
    const double ratio = orders.last > 0 ? std::min(energy / orders.last, kLargestRatio) : 0;
    orders.tail = ratio / (1 - ratio);
    orders.all += energy;
    orders.last = energy;
    return !(energy > 0) || (order > 2 && energy * orders.tail <= kLargestTail * orders.all);
}

// Over all cells, W m: of the largest channel.
double FarOrders::energyOf(const gpu::ReadableBuffer& cells) {
    commands_.run("reading far orders", [&](VkCommandBuffer commands) {
        gpu::computeBarrier(commands);
        cells.recordReadback(commands);
        hazeVolume_.recordReadback(commands);
    });
    const auto* fluence = static_cast<const vec3*>(cells.data());
    const auto* volume = static_cast<const float*>(hazeVolume_.data());
    double energy = 0;
    for (std::size_t i = 0; i < std::size_t{bricks_} * kOrderCells; ++i) {
        energy += double(volume[i]) * std::max({fluence[i].r, fluence[i].g, fluence[i].b});
    }
    return energy;
}

void FarOrders::writeTable(const Bake& bake, const Orders& orders) {
    contents_.field = addressWords(bake.field);
    contents_.bake = addressWords(bake.bake);
    contents_.energyUnit = std::max(bake.strongest * bake.nearRadius, 1e-30f) * kEnergyUnit;
    contents_.windowCount = bake.windows;
    contents_.lastOrder = orders.number;
    contents_.tail = float(orders.tail);
    commands_.upload(table_, &contents_, sizeof contents_);
}

std::uint64_t FarOrders::bytes() const {
    std::uint64_t bytes = 0;
    for (const gpu::Buffer& array : arrays_) {
        bytes += array.bytes();
    }
    for (const gpu::Buffer* buffer : {&table_, &nearEnergy_, &hazeVolume_.buffer(),
                                      &first_.buffer(), &orders_[0].buffer(),
                                      &orders_[1].buffer()}) {
        bytes += *buffer ? buffer->bytes() : 0;
    }
    return bytes;
}

}  // namespace nightcity
