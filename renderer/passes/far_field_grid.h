// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The far part of the fluence on the device (shaders/shared/far_field.h): laid out for a
// scene, baked for the windows that are on, updated when others are.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dispatch.h"
#include "far_bake.h"
#include "frame.h"
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/compute_pipeline.h"
#include "gpu/readable_buffer.h"
#include "passes/brick_batches.h"
#include "passes/far_layout.h"
#include "passes/far_lights.h"
#include "passes/far_orders.h"
#include "scene/convex_faces.h"
#include "scene/flat_scene.h"
#include "settings.h"

namespace nightcity {

struct FarFieldSettings {
    Emitter emitter = Emitter::pane;
    Visibility visibility = Visibility::full;
    Scattering scattering = Scattering::single;
    Surfaces surfaces = Surfaces::dim;  // with Scattering::multiple: lit ones reflect into the haze
    float spacing = 1;     // of the nodes where they are densest, m
    float nearRadius = 4;  // R of near_far_split.h, m; at least 4 spacings keep 1 %
    bool keepMean = true;  // nodes hold what keeps the mean between them, not what is at them
    float spread = 0.06f;  // windows within this share of their distance are one; 0: never
    std::vector<vec3> eyes;  // m, where the camera of the shot is (FarDetail)
    std::uint64_t mostBricks = 6000;            // FarDetail; with eyes
    std::uint64_t memoryBytes = 1'000'000'000;  // of the bricks, most

    bool operator==(const FarFieldSettings&) const = default;
};

// What the layout of the bricks asks for. The settings must outlive it.
FarDetail farDetail(const FlatScene& scene, const FarFieldSettings& settings);

// Of the entries of a batch, for so many windows: more only where one brick alone has more.
std::uint64_t farEntryBytes(std::uint64_t windows);

class FarFieldGrid {
public:
    FarFieldGrid(gpu::Device& device, gpu::Commands& commands)
        : device_(device), commands_(commands), orders_(device, commands) {}

    // Lays the field out; the next bake is a full one. `sceneTable` must hold windows, ground
    // and occluders; with Scattering::multiple haze too, and with lit surfaces the light tree.
    // Throws DeviceError where the nodes pass the memory that they may take.
    void syncGeometry(const FlatScene& scene, const FarFieldSettings& settings,
                      VkDeviceAddress sceneTable, const BakeProgress& progress);
    // Bakes the windows that are on, one byte a window; only those that changed where an earlier
    // state was baked: the nodes are then those of a full bake, to the bit.
    void syncWindowState(const FlatScene& scene, std::span<const std::uint8_t> windowOn,
                         SceneAddresses addresses, const BakeProgress& progress);

    // Of the FarFieldTable; 0 before the first syncGeometry.
    VkDeviceAddress tableAddress() const { return table_ ? table_.address() : 0; }
    const FarFieldTable& table() const { return contents_; }
    const FarLayout& layout() const { return layout_; }
    const gpu::Buffer& nodes() const { return nodes_; }  // uvec2 each, as frames read them
    std::uint64_t nodeCount() const { return layout_.nodes(); }
    std::uint64_t brickCount() const { return layout_.bricks.size(); }
    std::uint64_t bytes() const;  // on the device
    // What the device took for the last syncWindowState, by pass, with the syncGeometry before it.
    const std::vector<PassTime>& passTimes() const { return passTimes_; }

private:
    // Adds one kind of entries to the sums (kSumFront and so on).
    struct SumPass {
        const char* name;
        gpu::ComputePipeline pipeline;
    };
    template <typename T>
    uvec2 uploadArray(const char* name, std::span<const T> data);
    uvec2 allocate(const char* name, std::uint64_t bytes);
    void makePipelines(const FarFieldSettings& settings);
    std::vector<SumPass> makeSumPasses(bool update);
    void uploadLayout(std::span<const FarMedium> media);
    void uploadHeights(const ConvexFaces& faces);
    void uploadLights();
    template <typename Visit>
    void visitBricks(const BakeProgress& progress, BakeShare share, Visit&& visit);
    void findSides(VkDeviceAddress sceneTable, const BakeProgress& progress);
    void makeEntryBuffers(std::uint32_t capacity);
    std::uint32_t bakeBatch(VkDeviceAddress sceneTable, BrickBatch batch);
    std::uint32_t findEntries(const PushConstants& push);
    void bakeFirstOrder(VkDeviceAddress sceneTable, const BakeProgress& progress, double end);
    void chooseNodeUnit();
    void dispatch(const char* name, const gpu::ComputePipeline& pipeline,
                  const PushConstants& push);
    void writeTables();
    PushConstants pushOf(VkDeviceAddress sceneTable, BrickBatch batch) const;

    gpu::Device& device_;
    gpu::Commands& commands_;
    FarFieldSettings settings_;
    FarLayout layout_;
    FarLights lights_;
    FarOrders orders_;
    std::vector<vec3> baked_;  // emission that the sums hold, one a light
    std::vector<std::uint8_t> bakedOn_;  // and the windows that were on; of Scattering::multiple
    bool hasSums_ = false;
    bool hasPipelines_ = false;
    std::vector<gpu::Buffer> arrays_;
    gpu::Buffer table_;
    gpu::Buffer bakeTable_;
    gpu::Buffer emission_, bakedEmission_, changed_;
    gpu::Buffer sums_;
    gpu::Buffer nodes_;
    gpu::Buffer entries_;
    gpu::ReadableBuffer entryCounts_;
    gpu::ReadableBuffer units_;
    std::vector<PassTime> passTimes_;
    FarFieldTable contents_{};
    FarBakeTable bake_{};
    gpu::ComputePipeline sides_, sight_, mesh_, finish_;
    std::array<std::vector<SumPass>, 2> sumPasses_;  // of full bakes, of updates
    bool hasPolygons_ = false;  // faces of more than four corners
    bool hasSpheres_ = false;
};

}  // namespace nightcity
