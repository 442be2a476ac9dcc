// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/gpu_scene.h"

#include <algorithm>
#include <span>

#include "passes/box_nodes.h"
#include "passes/far_media.h"
#include "passes/haze_tree.h"
#include "passes/light_tree.h"
#include "passes/near_panes.h"
#include "passes/occluder_tree.h"
#include "scene/surface_planes.h"
#include "scene/uniform_haze.h"
#include "transport/gauss_legendre.h"

namespace nightcity {
namespace {

constexpr VkBufferUsageFlags kBuildInput =
    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;

// A device may place a box by a rounded ray; the exact test is the shader's, so the box that
// the device tests is grown by more than the rounding of any ray within kilometres. m.
VkAabbPositionsKHR inflated(glm::vec3 lo, glm::vec3 hi) {
    const glm::vec3 size = glm::max(glm::abs(lo), glm::abs(hi));
    const float margin = 0.01f + 1e-5f * std::max({size.x, size.y, size.z});
    return {lo.x - margin, lo.y - margin, lo.z - margin,
            hi.x + margin, hi.y + margin, hi.z + margin};
}

glm::vec3 halfExtent(const Window& window) {
    if ((window.flags & kWindowSphere) != 0) {
        return glm::vec3(glm::length(window.halfU));
    }
    return glm::abs(window.halfU) + glm::abs(window.halfV);
}

std::vector<std::uint32_t> indicesOf(const FlatScene& scene) {
    std::vector<std::uint32_t> indices;
    indices.reserve(scene.triangles.size() * 3);
    for (const Triangle& triangle : scene.triangles) {
        indices.insert(indices.end(),
                       {triangle.vertex.x, triangle.vertex.y, triangle.vertex.z});
    }
    return indices;
}

std::vector<std::uint32_t> stateBits(std::span<const std::uint8_t> windowOn) {
    std::vector<std::uint32_t> words((windowOn.size() + 31) / 32);
    for (size_t i = 0; i < windowOn.size(); ++i) {
        words[i / 32] |= (windowOn[i] != 0 ? 1u : 0u) << (i % 32);
    }
    return words;
}

}  // namespace

uvec2 addressWords(VkDeviceAddress address) {
    return {static_cast<std::uint32_t>(address), static_cast<std::uint32_t>(address >> 32)};
}

template <typename T>
gpu::Buffer GpuScene::upload(const char* name, std::span<const T> data, VkBufferUsageFlags usage) {
    gpu::Buffer buffer(device_, name, data.size_bytes(), gpu::MemoryKind::device, usage);
    commands_.upload(buffer, data.data(), data.size_bytes());
    return buffer;
}

template <typename T>
uvec2 GpuScene::uploadArray(const char* name, std::span<const T> data) {
    gpu::Buffer buffer = upload(name, data, 0);
    const uvec2 address = addressWords(buffer.address());
    arrays_.push_back(std::move(buffer));
    return address;
}

void GpuScene::syncGeometry(const FlatScene& scene) {
    arrays_.clear();
    contents_ = {};
    farFieldSettings_.reset();
    uniformHaze_ = false;
    uploadGeometry(scene);
    scene.dropPages();
    uploadOccluders(scene);
    uploadMediaTree(scene);
    uploadHaze(scene);
    buildTriangles(scene);
    buildMedia(scene);
    buildLoosePanes(scene);
    buildTopLevel();
}

void GpuScene::uploadGeometry(const FlatScene& scene) {
    const FacadeTable facades = buildFacades(scene);
    looseWindows_ = facades.looseWindows;
    positions_ = {};
    positions_ = upload<vec3>("positions", scene.positions,
                              kBuildInput | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    contents_.positions = addressWords(positions_.address());
    if (!scene.texcoords.empty()) {
        contents_.texcoords = uploadArray("texcoords", scene.texcoords);
    }
    contents_.triangles = uploadArray("triangles", scene.triangles);
    contents_.materials = uploadArray("materials", scene.materials);
    contents_.texels = uploadArray("texels", scene.texels);
    contents_.windows = uploadArray("windows", scene.windows);
    contents_.mediaBoxes = uploadArray("media boxes", scene.mediaBoxes);
    contents_.facades = uploadArray<Facade>("facades", facades.facades);
    contents_.cellStart = uploadArray<uint>("facade cell starts", facades.cellStart);
    contents_.cellWindow = uploadArray<uint>("facade cell windows", facades.cellWindow);
    contents_.triangleFacade = uploadArray<uint>("facades of triangles", facades.triangleFacade);
    contents_.looseWindows = uploadArray<uint>("loose windows", facades.looseWindows);
    contents_.lightList = uploadArray("light list", scene.lightList);
    contents_.gaussPairs = uploadArray<float>("gauss pairs", kGaussPairs);
    uploadPlanes(scene, facades);
    contents_.groundMaterial = scene.ground ? scene.ground->material : kNone;
    contents_.groundHeight = scene.ground ? scene.ground->height : 0;
}

void GpuScene::uploadMediaTree(const FlatScene& scene) {
    if (scene.mediaBoxes.empty()) {
        return;
    }
    std::vector<Bounds> boxes;
    for (const MediaBox& box : scene.mediaBoxes) {
        boxes.push_back({glm::dvec3(box.lo), glm::dvec3(box.hi)});
    }
    contents_.mediaNodes = uploadArray<BoxNode>("media tree", buildBoxNodes(boxes));
    uniformHaze_ = nightcity::isHazeUniform(scene);
}

void GpuScene::uploadHaze(const FlatScene& scene) {
    const std::vector<FarMedium> haze = mergeMedia(scene);
    if (haze.empty()) {
        return;
    }
    contents_.haze = uploadArray<FarMedium>("haze", haze);
    contents_.hazeNodes = uploadArray<HazeNode>("haze tree", buildHazeTree(haze));
}

void GpuScene::uploadMediaPlanes(const FlatScene& scene) {
    std::vector<FarMedium> boxes;
    for (const MediaBox& box : scene.mediaBoxes) {
        boxes.push_back({box.lo, box.extinction, box.hi, box.extinction * box.albedo});
    }
    contents_.mediaPlanes = uvec2(0);
    if (!boxes.empty()) {
        mediaPlanes_ = upload<HazeNode>("media planes", buildHazeTree(boxes), 0);
        contents_.mediaPlanes = addressWords(mediaPlanes_.address());
    }
}

void GpuScene::uploadPlanes(const FlatScene& scene, const FacadeTable& facades) {
    const SurfacePlanes planes = findSurfacePlanes(scene, facades);
    contents_.trianglePlane = uploadArray<uint>("planes of triangles", planes.ofTriangle);
    contents_.windowPlane = uploadArray<uint>("planes of windows", planes.ofWindow);
}

void GpuScene::uploadNearField(const FlatScene& scene, const FarFieldSettings& settings) {
    NearTable table{};
    table.radius = farField_.table().nearRadius;
    const NearPanes near(scene, settings.emitter, settings.visibility, table.radius);
    near_ = near.extremes();
    nearField_.clear();
    const auto keep = [&](gpu::Buffer buffer) {
        nearField_.push_back(std::move(buffer));
        return addressWords(nearField_.back().address());
    };
    const NearField field = near.build(NearCells(farField_.layout(), table.radius));
    scene.dropPages();
    if (!field.tree.empty()) {
        table.tree = keep(upload<BoxNode>("near tree", field.tree, 0));
        table.panes = keep(upload<NearPane>("near panes", field.panes, 0));
        table.windows = keep(upload<uint>("windows of near panes", field.windows, 0));
    }
    contents_.nearField = keep(upload<NearTable>("near table", {&table, 1}, 0));
}

void GpuScene::uploadOccluders(const FlatScene& scene) {
    const OccluderTree tree = buildOccluderTree(scene);
    if (tree.nodes.empty()) {
        return;
    }
    contents_.occluderNodes = uploadArray<BoxNode>("occluder tree", tree.nodes);
    contents_.occluderFaces = uploadArray<OccluderFace>("occluder faces", tree.faces);
    contents_.occluderCorners = uploadArray<vec3>("occluder corners", tree.corners);
    contents_.triangleFace = uploadArray<uint>("faces of triangles", tree.faceOfTriangle);
}

void GpuScene::buildTriangles(const FlatScene& scene) {
    triangles_ = {};
    triangleIndices_ = {};
    triangleIndices_ = upload<std::uint32_t>("triangle indices", indicesOf(scene),
                                             kBuildInput | VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    chunks_ = chunkTriangles(scene);
    if (scene.triangles.empty()) {
        return;
    }
    gpu::TriangleGeometry geometry;
    geometry.positions = positions_.address();
    geometry.vertexCount = static_cast<std::uint32_t>(scene.positions.size());
    geometry.indices = triangleIndices_.address();
    geometry.triangleCount = static_cast<std::uint32_t>(scene.triangles.size());
    triangles_ = {device_, commands_, "building triangles", geometry};
}

void GpuScene::buildMedia(const FlatScene& scene) {
    media_ = {};
    if (scene.mediaBoxes.empty()) {
        return;
    }
    std::vector<VkAabbPositionsKHR> boxes;
    for (const MediaBox& box : scene.mediaBoxes) {
        boxes.push_back(inflated(box.lo, box.hi));
    }
    gpu::Buffer buffer(device_, "media bounds", boxes.size() * sizeof(VkAabbPositionsKHR),
                       gpu::MemoryKind::device, kBuildInput);
    commands_.upload(buffer, boxes.data(), boxes.size() * sizeof(VkAabbPositionsKHR));
    media_ = {device_, commands_, "media boxes",
              gpu::BoxGeometry{buffer.address(), static_cast<std::uint32_t>(boxes.size())}};
}

void GpuScene::buildLoosePanes(const FlatScene& scene) {
    loosePanes_ = {};
    if (looseWindows_.empty()) {
        return;
    }
    std::vector<VkAabbPositionsKHR> boxes;
    for (std::uint32_t index : looseWindows_) {
        const Window& window = scene.windows[index];
        const glm::vec3 half = halfExtent(window);
        boxes.push_back(inflated(window.centre - half, window.centre + half));
    }
    gpu::Buffer buffer(device_, "pane bounds", boxes.size() * sizeof(VkAabbPositionsKHR),
                       gpu::MemoryKind::device, kBuildInput);
    commands_.upload(buffer, boxes.data(), boxes.size() * sizeof(VkAabbPositionsKHR));
    loosePanes_ = {device_, commands_, "loose panes",
                   gpu::BoxGeometry{buffer.address(), static_cast<std::uint32_t>(boxes.size())}};
}

void GpuScene::buildTopLevel() {
    std::vector<gpu::StructureInstance> instances;
    contents_.surfaceMask = 0;
    contents_.mediaMask = 0;
    if (triangles_) {
        instances.push_back({&triangles_, kMaskTriangles});
        contents_.surfaceMask |= kMaskTriangles;
    }
    if (media_) {
        instances.push_back({&media_, kMaskMedia});
        contents_.mediaMask = kMaskMedia;
    }
    if (loosePanes_) {
        instances.push_back({&loosePanes_, kMaskLoosePanes});
        contents_.surfaceMask |= kMaskLoosePanes;
    }
    topLevel_ = {device_, commands_, "scene", std::span<const gpu::StructureInstance>(instances)};
}

void GpuScene::syncWindowState(const FlatScene& scene, int frame,
                               const RenderSettings& settings) {
    const std::vector<std::uint8_t> on = scene.windowsOn(frame);
    const std::vector<std::uint32_t> bits = stateBits(on);
    uploadState(windowOn_, "window state", bits.data(), bits.size() * 4);
    const bool lit =
        settings.method == Method::field && settings.model.surfaces == Surfaces::lit;
    if (settings.method == Method::path || settings.method == Method::gauss || lit) {
        uploadLightTree(scene, on, settings.model.emitter);
    }
    if (settings.method == Method::march || settings.method == Method::gauss) {
        lights_.upload(packLights(scene, on, settings.lightCap), settings.lightStorage);
    }
    contents_.windowOn = addressWords(windowOn_.address());
    contents_.marchMedia = addressWords(lights_.mediaAddress());
    writeTable();
}

void GpuScene::syncFarField(const FlatScene& scene, std::span<const std::uint8_t> windowOn,
                            const FarFieldSettings& settings, const BakeProgress& progress) {
    const bool isNew = farFieldSettings_ != settings;
    if (isNew) {
        farFieldSettings_.reset();
        nearField_.clear();
        farField_.syncGeometry(scene, settings, tableAddress(), progress);
        contents_.farField = addressWords(farField_.tableAddress());
    }
    farField_.syncWindowState(scene, windowOn, {tableAddress(), structure()}, progress);
    if (isNew) {  // after the bake, which has no need of it: so the two never share the memory
        uploadNearField(scene, settings);
        uploadMediaPlanes(scene);
        writeTable();
        farFieldSettings_ = settings;
    }
}

void GpuScene::uploadState(gpu::Buffer& buffer, const char* name, const void* data,
                           std::uint64_t bytes) {
    if (!buffer || buffer.bytes() < bytes) {
        buffer = {};
        buffer = gpu::Buffer(device_, name, bytes, gpu::MemoryKind::device);
    }
    commands_.upload(buffer, data, bytes);
}

void GpuScene::uploadLightTree(const FlatScene& scene, std::span<const std::uint8_t> windowOn,
                               Emitter emitter) {
    const LightTree tree = buildLightTree(scene, windowOn, emitter);
    contents_.lightNodes = uvec2(0);
    if (tree.nodes.empty()) {
        return;
    }
    uploadState(lightNodes_, "light tree", tree.nodes.data(),
                tree.nodes.size() * sizeof(LightNode));
    uploadState(lightTrails_, "light trails", tree.trails.data(), tree.trails.size() * 4);
    contents_.lightNodes = addressWords(lightNodes_.address());
    contents_.lightTrails = addressWords(lightTrails_.address());
}

void GpuScene::writeTable() {
    if (!table_) {
        table_ = gpu::Buffer(device_, "scene table", sizeof(SceneTable), gpu::MemoryKind::device);
    }
    commands_.upload(table_, &contents_, sizeof(SceneTable));
}

}  // namespace nightcity
