// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/pass_pipelines.h"

#include "accumulate_spirv.h"
#include "dispatch.h"
#include "gauss_points_spirv.h"
#include "gauss_spirv.h"
#include "lit_spirv.h"
#include "march_spirv.h"
#include "media_ids_spirv.h"
#include "path_spirv.h"
#include "surface_spirv.h"
#include "traverse_spirv.h"

namespace nightcity {
namespace {

// The layouts that GL_EXT_scalar_block_layout gives the same records.
static_assert(sizeof(MarchMedium) == 20);
static_assert(sizeof(SceneTable) == 30 * 8 + 16);
static_assert(sizeof(BoxNode) == 32);
static_assert(sizeof(OccluderFace) == 20);
static_assert(sizeof(HazeNode) == 12);
static_assert(sizeof(NearLights) == 64);
static_assert(sizeof(FrameTable) == 23 * 8 + 20 + sizeof(CameraFrame) + 12 + 8 + 24);
static_assert(sizeof(PushConstants) == 32);  // devices give at least 128
static_assert(sizeof(SurfaceRecord) == 32);
static_assert(sizeof(RayProgress) == 32);
static_assert(sizeof(Segment) == 28);
static_assert(sizeof(PassCounters) == 12);

std::vector<std::uint32_t> marchConstants(const PipelineChoice& choice) {
    std::vector<std::uint32_t> constants(5);
    constants[NIGHTCITY_CONSTANT_LIGHTS_OUTSIDE] = choice.order == MarchOrder::lights ? 1 : 0;
    constants[NIGHTCITY_CONSTANT_UNIFORM_PAGES] =
        choice.lights.storage == LightStorage::uniform ? 1 : 0;
    constants[NIGHTCITY_CONSTANT_PAGE_COUNT] = choice.lights.count;
    constants[NIGHTCITY_CONSTANT_PAGE_ENTRIES] = choice.lights.entriesEach;
    constants[NIGHTCITY_CONSTANT_SUBDIVISIONS] = choice.subdivisions;
    return constants;
}

std::vector<gpu::Binding> pageBindings(const LightPages& pages) {
    const bool uniform = pages.storage == LightStorage::uniform;
    return {{NIGHTCITY_BINDING_UNIFORM_PAGES, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
             uniform ? pages.count : 1},
            {NIGHTCITY_BINDING_STORAGE_PAGES, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
             uniform ? 1 : pages.count}};
}

}  // namespace

gpu::ComputePipeline makePipeline(gpu::Device& device, const char* name,
                                  std::span<const std::uint32_t> spirv,
                                  std::vector<gpu::Binding> bindings,
                                  std::vector<std::uint32_t> constants) {
    gpu::ComputePipelineInfo info;
    info.name = name;
    info.spirv = spirv;
    info.bindings = std::move(bindings);
    info.pushConstantBytes = sizeof(PushConstants);
    info.constants = std::move(constants);
    return {device, info};
}

std::vector<std::uint32_t> modelConstants(const Model& model, bool media) {
    std::vector<std::uint32_t> constants(5);
    constants[NIGHTCITY_CONSTANT_MEDIA] = media ? 1 : 0;
    constants[NIGHTCITY_CONSTANT_EMITTER] = emitterConstant(model.emitter);
    constants[NIGHTCITY_CONSTANT_VISIBILITY] = model.visibility == Visibility::full ? 1 : 0;
    constants[NIGHTCITY_CONSTANT_LISTED] = model.lights == Lights::listed ? 1 : 0;
    constants[NIGHTCITY_CONSTANT_LIT] = model.surfaces == Surfaces::lit ? 1 : 0;
    return constants;
}

std::uint32_t emitterConstant(Emitter emitter) {
    return emitter == Emitter::isotropic    ? kEmitterIsotropic
           : emitter == Emitter::lambertian ? kEmitterLambertian
                                            : kEmitterPane;
}

bool PipelineChoice::readsPages() const {
    Model points;  // the paper's, whatever surfaces show
    points.surfaces = model.surfaces;
    return method == Method::march || (method == Method::gauss && model == points);
}

PassPipelines::PassPipelines(gpu::Device& device, const PipelineChoice& settings)
    : choice(settings) {
    const bool knowsReaders = choice.method == Method::field && !choice.lightsSurfaces();
    const bool records = choice.task == kTaskRecords;
    surface = makePipeline(device, "surface", kSurfaceSpirv, {kStructureBinding},
                           {choice.task, records && !knowsReaders ? kAllAovs : choice.aovs});
    if (choice.task != kTaskRecords) {
        return;
    }
    if (choice.method == Method::path) {
        makePath(device);
    } else if (choice.method == Method::gauss) {
        makeGauss(device);
    } else if (choice.method == Method::field) {
        makeLit(device);
        mediaIds = makePipeline(device, "media ids", kMediaIdsSpirv, {kStructureBinding});
    } else {
        makeMarch(device);
    }
    accumulate = makePipeline(device, "accumulate", kAccumulateSpirv, {},
                              {choice.media ? 1u : 0u, choice.aovs});
}

void PassPipelines::makeMarch(gpu::Device& device) {
    traverse = makePipeline(device, "traverse", kTraverseSpirv, {kStructureBinding});
    inScatter = makePipeline(device, "march", kMarchSpirv, pageBindings(choice.lights),
                             marchConstants(choice));
}

void PassPipelines::makeLit(gpu::Device& device) {
    if (choice.lightsSurfaces()) {
        lit = makePipeline(device, "lit", kLitSpirv, {},
                           modelConstants(choice.model, choice.media));
    }
}

void PassPipelines::makeGauss(gpu::Device& device) {
    traverse = makePipeline(device, "traverse", kTraverseSpirv, {kStructureBinding});
    makeLit(device);
    if (choice.readsPages()) {
        inScatter = makePipeline(device, "gauss", kGaussPointsSpirv, pageBindings(choice.lights),
                                 marchConstants(choice));
    } else {
        std::vector<std::uint32_t> constants = modelConstants(choice.model, choice.media);
        constants.push_back(choice.uniformHaze ? 1 : 0);
        inScatter = makePipeline(device, "gauss", kGaussSpirv, {}, constants);
    }
}

void PassPipelines::makePath(gpu::Device& device) {
    path = makePipeline(device, "path", kPathSpirv, {kStructureBinding},
                        modelConstants(choice.model, choice.media));
}

void PassPipelines::bind(const GpuScene& scene) {
    surface.bindAccelerationStructure(NIGHTCITY_BINDING_STRUCTURE, scene.structure());
    if (choice.task != kTaskRecords) {
        return;
    }
    if (choice.method == Method::path) {
        path.bindAccelerationStructure(NIGHTCITY_BINDING_STRUCTURE, scene.structure());
        return;
    }
    if (choice.method == Method::field) {
        mediaIds.bindAccelerationStructure(NIGHTCITY_BINDING_STRUCTURE, scene.structure());
        return;
    }
    traverse.bindAccelerationStructure(NIGHTCITY_BINDING_STRUCTURE, scene.structure());
    if (choice.readsPages()) {
        scene.lights().bind(inScatter);
    }
}

std::vector<const gpu::ComputePipeline*> PassPipelines::all() const {
    if (choice.task != kTaskRecords) {
        return {&surface};
    }
    if (choice.method == Method::path) {
        return {&surface, &path, &accumulate};
    }
    std::vector<const gpu::ComputePipeline*> all{&surface};
    if (choice.lightsSurfaces()) {
        all.push_back(&lit);
    }
    if (choice.method == Method::field) {
        all.push_back(&mediaIds);
    } else {
        all.insert(all.end(), {&traverse, &inScatter, &accumulate});
    }
    return all;
}

}  // namespace nightcity
