// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/far_field_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "far_finish_spirv.h"
#include "far_mesh_spirv.h"
#include "far_sides_spirv.h"
#include "far_sight_spirv.h"
#include "far_sum_spirv.h"
#include "passes/box_nodes.h"
#include "passes/far_media.h"
#include "passes/height_map.h"
#include "passes/pass_pipelines.h"

namespace nightcity {
namespace {

// The layouts that GL_EXT_scalar_block_layout gives the same records.
static_assert(sizeof(FarMedium) == 32);
static_assert(sizeof(FarBrick) == 24);
static_assert(sizeof(FarFieldTable) == 5 * 8 + 40);
static_assert(sizeof(FarLight) == 56);
static_assert(sizeof(FarEntry) == 12 + 4 * (3 * kWayWords + kFarFaces));
static_assert(sizeof(FarBakeTable) == 12 * 8 + 32 + 8 * 3 + 4);

// Of all that a bake does, when the sides and when the sums are done.
constexpr double kSidesShare = 0.05;
constexpr double kSumsShare = 0.97;
// Of a bake of all orders, when the first is done.
constexpr double kFirstOrderShare = 0.4;
constexpr std::uint32_t kFirstCapacity = 512;  // entries a brick
constexpr std::uint64_t kEntryBytes = 64u << 20;  // of a batch, most
constexpr float kCellSpacings = 0.5f;  // of the smallest bricks, a cell of the map of heights
constexpr float kOrdersRoom = 4;  // of all orders to the first, at most, where it is brightest

float skyHeight(const FlatScene& scene) {
    float height = scene.ground ? scene.ground->height : 0;
    for (const vec3& position : scene.positions) {
        height = std::max(height, position.z);
    }
    return height + 1;
}

bool hasSpheres(const FlatScene& scene) {
    return std::any_of(scene.windows.begin(), scene.windows.end(), [](const Window& window) {
        return (window.flags & kWindowSphere) != 0;
    });
}

// Whether some opaque face has more than four corners.
bool hasPolygons(const ConvexFaces& faces) {
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
        if (faces.face(i).size() > 4) {
            return true;
        }
    }
    return false;
}

Model ordersModel(const FarFieldSettings& settings) {
    Model model;
    model.lights = Lights::all;
    model.visibility = settings.visibility;
    model.emitter = settings.emitter;
    model.surfaces = settings.surfaces;
    return model;
}

}  // namespace

FarDetail farDetail(const FlatScene& scene, const FarFieldSettings& settings) {
    return {alignLattice(scene.mediaBoxes, settings.spacing, settings.emitter), settings.eyes,
            settings.mostBricks, settings.memoryBytes};
}

std::uint64_t farEntryBytes(std::uint64_t windows) {
    const std::uint64_t first = std::uint64_t{kFirstCapacity} * kBatchBricks * sizeof(FarEntry);
    return windows <= kFirstCapacity ? first : std::max(first, kEntryBytes);
}

template <typename T>
uvec2 FarFieldGrid::uploadArray(const char* name, std::span<const T> data) {
    arrays_.emplace_back(device_, name, data.size_bytes(), gpu::MemoryKind::device);
    commands_.upload(arrays_.back(), data.data(), data.size_bytes());
    return addressWords(arrays_.back().address());
}

uvec2 FarFieldGrid::allocate(const char* name, std::uint64_t bytes) {
    arrays_.emplace_back(device_, name, bytes, gpu::MemoryKind::device);
    return addressWords(arrays_.back().address());
}

void FarFieldGrid::syncGeometry(const FlatScene& scene, const FarFieldSettings& settings,
                                VkDeviceAddress sceneTable, const BakeProgress& progress) {
    hasSums_ = false;
    passTimes_.clear();
    arrays_.clear();
    sums_ = {};
    nodes_ = {};
    contents_ = {};
    bake_ = {};
    if (!hasPipelines_ || settings.emitter != settings_.emitter ||
        settings.visibility != settings_.visibility || settings.keepMean != settings_.keepMean) {
        makePipelines(settings);
    }
    settings_ = settings;
    const std::vector<FarMedium> media = mergeMedia(scene);
    layout_ = layoutFarField(media, farDetail(scene, settings_));
    const FarCut cut(layout_, {settings.emitter, settings.nearRadius, settings.spread});
    lights_ = buildFarLights(scene, media, cut, settings.emitter);
    scene.dropPages();
    bool polygons = false;
    const bool spheres = hasSpheres(scene);
    {
        const ConvexFaces faces(scene);
        polygons = hasPolygons(faces);
        uploadHeights(faces);
    }
    if (polygons != hasPolygons_ || spheres != hasSpheres_) {
        hasPolygons_ = polygons;
        hasSpheres_ = spheres;
        sumPasses_ = {};
    }
    bake_.skyHeight = skyHeight(scene);
    for (const FarMedium& medium : media) {
        bake_.thickest = std::max(bake_.thickest, medium.extinction);
    }
    bake_.spread = settings.spread;
    uploadLayout(media);
    uploadLights();
    writeTables();
    if (settings_.scattering == Scattering::multiple) {
        orders_.syncGeometry(layout_.bricks.size(), ordersModel(settings_));
    } else {
        orders_.clear();
    }
    findSides(sceneTable, progress);
}

void FarFieldGrid::makePipelines(const FarFieldSettings& settings) {
    const std::uint32_t visibility = settings.visibility == Visibility::full ? 1 : 0;
    const std::uint32_t mean = settings.keepMean ? 1 : 0;
    const std::vector<std::uint32_t> constants{emitterConstant(settings.emitter), visibility, mean};
    sides_ = makePipeline(device_, "far sides", kFarSidesSpirv, {}, constants);
    sight_ = makePipeline(device_, "far sight", kFarSightSpirv, {}, constants);
    mesh_ = makePipeline(device_, "far mesh", kFarMeshSpirv, {}, constants);
    finish_ = makePipeline(device_, "far finish", kFarFinishSpirv, {}, constants);
    hasPipelines_ = true;
    sumPasses_ = {};
}

// One pass for each kind of entries there are: none has to be able to do what others need.
std::vector<FarFieldGrid::SumPass> FarFieldGrid::makeSumPasses(bool update) {
    std::vector<SumPass> passes;
    const auto add = [&](const char* name, std::uint32_t part) {
        const std::vector<std::uint32_t> constants{
            emitterConstant(settings_.emitter),
            settings_.visibility == Visibility::full ? 1u : 0u,
            settings_.keepMean ? 1u : 0u,
            part,
            update ? 1u : 0u,
            hasPolygons_ ? 1u : 0u};
        passes.push_back({name, makePipeline(device_, name, kFarSumSpirv, {}, constants)});
    };
    if (hasSpheres_) {
        add("far sum", kSumFront);
    } else {
        add("far sum", kSumFine);
        add("far sum coarse", kSumCoarse);
    }
    add("far sum clusters", kSumClusters);
    return passes;
}

void FarFieldGrid::uploadLayout(std::span<const FarMedium> media) {
    contents_.index = uploadArray<uint>("far index", layout_.index);
    contents_.bricks = uploadArray<FarBrick>("far bricks", layout_.bricks);
    contents_.media = uploadArray<FarMedium>("far media", media);
    contents_.mediumList = uploadArray<uint>("far medium lists", layout_.mediumList);
    nodes_ = gpu::Buffer(device_, "far nodes", layout_.nodes() * sizeof(uvec2),
                         gpu::MemoryKind::device);
    contents_.nodes = addressWords(nodes_.address());
    contents_.origin = layout_.origin;
    contents_.cellSide = layout_.cellSide;
    contents_.cellCounts = layout_.counts;
    contents_.nearRadius = settings_.nearRadius;
    contents_.blurredScale = blurredScale(settings_.nearRadius, layout_.cellSide / float(kBrickSteps));
    contents_.nodeUnit = 1;
    bake_.sides = allocate("far sides", layout_.bricks.size() * kBrickSideWords * 4);
    units_ = gpu::ReadableBuffer(device_, "far units", layout_.bricks.size() * 4);
    bake_.units = addressWords(units_.buffer().address());
    sums_ = gpu::Buffer(device_, "far sums", layout_.nodes() * sizeof(uvec3),
                        gpu::MemoryKind::device);
    bake_.sums = addressWords(sums_.address());
    if (!media.empty()) {
        std::vector<Bounds> bounds;
        for (const FarMedium& medium : media) {
            bounds.push_back({glm::dvec3(medium.lo), glm::dvec3(medium.hi)});
        }
        bake_.mediaNodes =
            uploadArray<BoxNode>("far media tree", buildBoxNodes(bounds));
    }
}

void FarFieldGrid::uploadHeights(const ConvexFaces& faces) {
    if (!layout_.hasLargeBricks() || settings_.visibility != Visibility::full) {
        return;
    }
    const float cellSide = kCellSpacings * layout_.cellSide / float(kBrickSteps);
    const HeightMap map = buildHeightMap(faces, cellSide);
    bake_.heightOrigin = map.origin;
    bake_.heightCounts = map.counts;
    bake_.heightCell = map.cellSide;
    bake_.heights = uploadArray<float>("far heights", map.heights);
}

void FarFieldGrid::uploadLights() {
    bake_.lights = uploadArray<FarLight>("far lights", lights_.lights);
    bake_.roots = uploadArray<uint>("far roots", lights_.roots);
    bake_.lightCount = static_cast<std::uint32_t>(lights_.lights.size());
    bake_.rootCount = static_cast<std::uint32_t>(lights_.roots.size());
    const std::uint64_t bytes = lights_.lights.size() * sizeof(vec3);
    emission_ = gpu::Buffer(device_, "far emission", bytes, gpu::MemoryKind::device);
    bakedEmission_ = gpu::Buffer(device_, "far baked emission", bytes, gpu::MemoryKind::device);
    changed_ = gpu::Buffer(device_, "far changed lights", (lights_.lights.size() + 31) / 32 * 4,
                           gpu::MemoryKind::device);
    bake_.emission = addressWords(emission_.address());
    bake_.baked = addressWords(bakedEmission_.address());
    bake_.changed = addressWords(changed_.address());
    // The largest that one window brings anywhere (far_sight.comp), in 2^14 parts: so the
    // bounds of 2^18 windows at arm's length still fit.
    const double radius = settings_.nearRadius;
    const double largest = 8.0 * double(lights_.strongest) / (std::numbers::pi * radius * radius);
    bake_.boundUnit = float(std::max(largest, 1e-30) / 16384.0);
    makeEntryBuffers(kFirstCapacity);
}

void FarFieldGrid::makeEntryBuffers(std::uint32_t capacity) {
    entries_ = {};
    entryCounts_ = {};
    const std::uint64_t each = std::uint64_t{capacity} * sizeof(FarEntry);
    const auto bricks = static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(kEntryBytes / each, 1, kBatchBricks));
    entries_ = gpu::Buffer(device_, "far entries", each * bricks, gpu::MemoryKind::device);
    entryCounts_ = gpu::ReadableBuffer(device_, "far entry counts",
                                       std::uint64_t{bricks} * sizeof(uvec2));
    bake_.entries = addressWords(entries_.address());
    bake_.entryCounts = addressWords(entryCounts_.buffer().address());
    bake_.entryCapacity = capacity;
}

void FarFieldGrid::writeTables() {
    if (!table_) {
        table_ = gpu::Buffer(device_, "far field table", sizeof(FarFieldTable),
                             gpu::MemoryKind::device);
        bakeTable_ = gpu::Buffer(device_, "far bake table", sizeof(FarBakeTable),
                                 gpu::MemoryKind::device);
    }
    bake_.field = addressWords(table_.address());
    commands_.upload(table_, &contents_, sizeof contents_);
    commands_.upload(bakeTable_, &bake_, sizeof bake_);
}

PushConstants FarFieldGrid::pushOf(VkDeviceAddress sceneTable, BrickBatch batch) const {
    PushConstants push{};
    push.scene = addressWords(sceneTable);
    push.frame = addressWords(bakeTable_.address());
    push.firstPixel = batch.first;
    push.pixelCount = batch.count;
    return push;
}

void FarFieldGrid::dispatch(const char* name, const gpu::ComputePipeline& pipeline,
                            const PushConstants& push) {
    addPassTime(passTimes_, name, commands_.run(name, [&](VkCommandBuffer commands) {
        pipeline.dispatch(commands, &push, push.pixelCount);
        gpu::computeBarrier(commands);
    }));
}

std::uint64_t FarFieldGrid::bytes() const {
    std::uint64_t bytes = orders_.bytes();
    for (const gpu::Buffer& array : arrays_) {
        bytes += array.bytes();
    }
    for (const gpu::Buffer* buffer : {&table_, &bakeTable_, &emission_, &bakedEmission_, &changed_,
                                      &sums_, &nodes_, &entries_, &entryCounts_.buffer(),
                                      &units_.buffer()}) {
        bytes += *buffer ? buffer->bytes() : 0;
    }
    return bytes;
}

template <typename Visit>
void FarFieldGrid::visitBricks(const BakeProgress& progress, BakeShare share, Visit&& visit) {
    forBatches(static_cast<std::uint32_t>(layout_.bricks.size()), progress, share, visit);
}

void FarFieldGrid::findSides(VkDeviceAddress sceneTable, const BakeProgress& progress) {
    visitBricks(progress, {0, kSidesShare}, [&](BrickBatch batch) {
        dispatch("far sides", sides_, pushOf(sceneTable, batch));
        return batch.count;
    });
}

void FarFieldGrid::syncWindowState(const FlatScene& scene, std::span<const std::uint8_t> windowOn,
                                   SceneAddresses addresses, const BakeProgress& progress) {
    const std::vector<vec3> emission = emissionOf(lights_, scene, windowOn);
    scene.dropPages();
    if (hasSums_) {
        passTimes_.clear();
    }
    // Higher orders know windows one by one that are one light of the tree.
    const bool isMultiple = settings_.scattering == Scattering::multiple;
    const bool isSame =
        emission == baked_ && (!isMultiple || std::ranges::equal(windowOn, bakedOn_));
    if (hasSums_ && isSame) {
        return;
    }
    if (!hasSums_) {
        baked_.assign(emission.size(), vec3(0));
        commands_.run("clearing far sums", [&](VkCommandBuffer commands) {
            vkCmdFillBuffer(commands, sums_.get(), 0, VK_WHOLE_SIZE, 0);
            gpu::computeBarrier(commands);
        });
    }
    const std::vector<uint> changed = changedLights(lights_, baked_, emission);
    commands_.upload(emission_, emission.data(), emission.size() * sizeof(vec3));
    commands_.upload(bakedEmission_, baked_.data(), baked_.size() * sizeof(vec3));
    commands_.upload(changed_, changed.data(), changed.size() * 4);
    bake_.update = hasSums_ ? 1 : 0;
    std::vector<SumPass>& passes = sumPasses_[bake_.update];
    if (passes.empty()) {
        passes = makeSumPasses(hasSums_);
    }
    hasSums_ = false;  // until all bricks have the new state
    writeTables();
    const double firstEnd = isMultiple ? kFirstOrderShare : 1;
    bakeFirstOrder(addresses.table, progress, firstEnd);
    if (isMultiple) {
        orders_.add({contents_.nearRadius, static_cast<std::uint32_t>(scene.windows.size()),
                     lights_.strongest, table_.address(), bakeTable_.address(), addresses},
                    progress, {firstEnd, 1}, passTimes_);
        bakedOn_.assign(windowOn.begin(), windowOn.end());
    }
    baked_ = emission;
    hasSums_ = true;
}

// `end`: of all that the bake does.
void FarFieldGrid::bakeFirstOrder(VkDeviceAddress sceneTable, const BakeProgress& progress,
                                  double end) {
    visitBricks(progress, {kSidesShare, kSumsShare * end},
                [&](BrickBatch batch) { return bakeBatch(sceneTable, batch); });
    if (bake_.update == 0) {
        chooseNodeUnit();
    }
    visitBricks(progress, {kSumsShare * end, end}, [&](BrickBatch batch) {
        dispatch("far finish", finish_, pushOf(sceneTable, batch));
        return batch.count;
    });
}

// Returns how many bricks of the batch there was room for: 0 where their entries need more.
std::uint32_t FarFieldGrid::bakeBatch(VkDeviceAddress sceneTable, BrickBatch batch) {
    const auto room = static_cast<std::uint32_t>(entryCounts_.bytes() / sizeof(uvec2));
    batch.count = std::min(batch.count, room);
    const PushConstants push = pushOf(sceneTable, batch);
    const std::uint32_t most = findEntries(push);
    if (most > bake_.entryCapacity) {
        makeEntryBuffers(most + most / 4);
        writeTables();
        return 0;
    }
    dispatch("far mesh", mesh_, push);
    for (const SumPass& pass : sumPasses_[bake_.update]) {
        dispatch(pass.name, pass.pipeline, push);
    }
    return batch.count;
}

// Returns the most that a brick has.
std::uint32_t FarFieldGrid::findEntries(const PushConstants& push) {
    addPassTime(passTimes_, "far sight", commands_.run("far sight", [&](VkCommandBuffer commands) {
        vkCmdFillBuffer(commands, entryCounts_.buffer().get(), 0, VK_WHOLE_SIZE, 0);
        gpu::computeBarrier(commands);
        sight_.dispatch(commands, &push, push.pixelCount);
        gpu::computeBarrier(commands);
        entryCounts_.recordReadback(commands);
        units_.recordReadback(commands);
    }));
    const auto* counts = static_cast<const uvec2*>(entryCounts_.data());
    std::uint32_t most = 0;
    for (std::uint32_t i = 0; i < push.pixelCount; ++i) {
        most = std::max(most, counts[i].x + counts[i].y);
    }
    return most;
}

// So that no sum passes what a half holds, whichever windows are on; nor with what other orders
// bring beside it.
void FarFieldGrid::chooseNodeUnit() {
    if (layout_.bricks.empty()) {
        return;
    }
    const auto* units = static_cast<const float*>(units_.data());
    const float largest = *std::max_element(units, units + layout_.bricks.size());
    const float room = settings_.scattering == Scattering::multiple ? kOrdersRoom : 1;
    contents_.nodeUnit = room * std::ldexp(largest, 31) / kLargestHalf;
    writeTables();
}

}  // namespace nightcity
