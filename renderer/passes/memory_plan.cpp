// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/memory_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dispatch.h"
#include "errors.h"
#include "facade.h"
#include "glow.h"
#include "gpu/acceleration_structure.h"
#include "passes/far_alignment.h"
#include "passes/far_media.h"
#include "passes/height_map.h"
#include "passes/frame_renderer.h"
#include "passes/near_cells.h"

namespace nightcity {
namespace {

// Nodes of a tree over boxes are at most so many a box (box_nodes.cpp).
constexpr double kNodesABox = 1.75;
// Cells of facades: their starts and the windows in them (facades.cpp), each about four a window.
constexpr double kCellsAWindow = 10;
constexpr double kEdgesAFace = 4;
constexpr std::uint64_t kRoom = 4u << 20;  // of tables, counters and lists that grow

std::uint64_t bytesOf(double count, double each) {
    return static_cast<std::uint64_t>(std::ceil(count * each));
}

std::uint64_t sceneBytes(const FlatScene& scene) {
    const double triangles = double(scene.triangles.size());
    const double windows = double(scene.windows.size());
    const double media = double(scene.mediaBoxes.size());
    const double facades = std::min(windows, triangles / 2);
    const double faces = triangles;
    return scene.positions.size_bytes() + scene.texcoords.size_bytes() +
           scene.triangles.size_bytes() + scene.materials.size_bytes() +
           scene.texels.size_bytes() + scene.windows.size_bytes() +
           scene.mediaBoxes.size_bytes() + scene.lightList.size_bytes() +
           bytesOf(facades, sizeof(Facade)) +
           // Indices, and the facade, the face and the plane of each.
           bytesOf(triangles, (3 + 3) * 4) + bytesOf(windows, (kCellsAWindow + 1) * 4 + 0.125) +
           bytesOf(faces, 0.5 * (sizeof(OccluderFace) + kNodesABox * sizeof(BoxNode) +
                                 kEdgesAFace * sizeof(vec3))) +
           bytesOf(media, kNodesABox * sizeof(BoxNode) + sizeof(FarMedium) +
                              2 * sizeof(HazeNode));
}

std::uint64_t structureBytes(gpu::Device& device, const FlatScene& scene) {
    const gpu::StructureBytes triangles = gpu::triangleStructureBytes(
        device, std::uint32_t(scene.positions.size()), std::uint32_t(scene.triangles.size()));
    const gpu::StructureBytes media =
        gpu::boxStructureBytes(device, std::uint32_t(scene.mediaBoxes.size()));
    return triangles.structure + media.structure + std::max(triangles.scratch, media.scratch);
}

std::uint64_t lightBytes(const FlatScene& scene, const RenderSettings& settings) {
    const double windows = double(scene.windows.size());
    const bool lists = settings.method == Method::march || settings.method == Method::gauss;
    const bool tree = settings.method == Method::path || settings.method == Method::gauss ||
                      (settings.method == Method::field &&
                       settings.model.surfaces == Surfaces::lit);
    // A light and at most a run of its own for each entry.
    const std::uint64_t listBytes = bytesOf(double(scene.lightList.size()), 2 * sizeof(vec4)) +
                                    bytesOf(double(scene.mediaBoxes.size()), sizeof(MarchMedium)) +
                                    65536;
    return (lists ? listBytes : 0) + (tree ? bytesOf(windows, 2 * sizeof(LightNode) + 4) : 0);
}

std::uint64_t fieldBytes(const FlatScene& scene, const FarFieldSettings& settings) {
    const std::vector<FarMedium> media = mergeMedia(scene);
    const FarLayout layout = layoutFarField(media, farDetail(scene, settings));
    const std::uint64_t bricks = layout.bricks.size();
    const std::uint64_t windows = scene.windows.size();
    const std::uint64_t lights = plannedFarLights(layout, windows);
    const std::uint64_t grid = layout.nodes() * kFarNodeBytes +
                               bricks * (sizeof(FarBrick) + 4 * kBrickSideWords + 4) +
                               4 * (layout.index.size() + layout.mediumList.size());
    const NearCells cells(layout, settings.nearRadius);
    const auto panes = std::ranges::count_if(
        scene.windows, [&](const Window& window) { return cells.reaches(window.centre); });
    const std::uint64_t near =
        bytesOf(double(panes), sizeof(NearPane) + 4 + kNodesABox * sizeof(BoxNode));
    const std::uint64_t orders =
        settings.scattering == Scattering::multiple ? farOrderBytes(bricks, settings.surfaces) : 0;
    return grid + orders + lights * (sizeof(FarLight) + 2 * sizeof(vec3) + 1) +
           farEntryBytes(windows) + near + media.size() * 4 * sizeof(FarMedium) +
           (layout.hasLargeBricks() ? kHeightMapBytes : 0);
}

std::uint64_t frameBytes(const gpu::Device& device, const RenderProduct& product,
                         const RenderSettings& settings) {
    const std::uint64_t pixels = std::uint64_t{product.width} * product.height;
    const std::uint64_t rays = FrameRenderer::mostRays(product, settings.method);
    std::uint64_t images = sizeof(vec4) + 3 * sizeof(vec3) + 4 * sizeof(float);
    std::uint64_t ray = sizeof(SurfaceRecord) + sizeof(RayProgress);
    if (settings.method == Method::field) {
        images += 2 * sizeof(float);
        ray += sizeof(GlowSample) + sizeof(GlowLedger) + 8;  // of cells and tiles, a pixel
    } else if (settings.method == Method::path) {
        images += sizeof(vec3);
        ray += sizeof(PathSums) + sizeof(NearLights) + sizeof(vec3);
    } else {
        ray += kSegmentSlots * sizeof(Segment);
    }
    const std::uint64_t copies = device.unifiedMemory() ? 1 : 2;  // one that the host reads
    const std::uint64_t raster = pixels * 12;  // two images and a table of the frame
    return rays * (ray + copies * images) + raster + product.pixels.size() * sizeof(uvec2);
}

// As --memory takes it, rounded up.
std::string sizeText(std::uint64_t bytes) {
    char text[32];
    const double mebibytes = double(bytes) / double(1u << 20);
    if (mebibytes < 1024) {
        std::snprintf(text, sizeof text, "%.0fM", std::ceil(mebibytes));
    } else {
        std::snprintf(text, sizeof text, "%.2fG", std::ceil(mebibytes / 10.24) / 100);
    }
    return text;
}

}  // namespace

MemoryPlan planMemory(gpu::Device& device, const FlatScene& scene, const RenderProduct& product,
                      const RenderSettings& settings, const FarFieldSettings* field) {
    MemoryPlan plan;
    plan.scene = sceneBytes(scene) + kRoom;
    plan.structures = structureBytes(device, scene);
    plan.lights = lightBytes(scene, settings);
    plan.field = field != nullptr ? fieldBytes(scene, *field) : 0;
    plan.frame = frameBytes(device, product, settings);
    return plan;
}

void requireMemory(const MemoryPlan& plan, std::uint64_t budget, const std::string& device) {
    if (plan.bytes() <= budget) {
        return;
    }
    throw DeviceError("--memory " + sizeText(budget) + " is too little: " + device + " needs " +
                      sizeText(plan.bytes()) + " (scene " + sizeText(plan.scene) +
                      ", acceleration structures " + sizeText(plan.structures) +
                      ", light lists and trees " + sizeText(plan.lights) + ", field " +
                      sizeText(plan.field) + ", frame " + sizeText(plan.frame) +
                      "); allow more, render a smaller --size or --tile, or a smaller city");
}

}  // namespace nightcity
