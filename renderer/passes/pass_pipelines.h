// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The compute pipelines of a frame, made for one choice of settings.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "aovs.h"
#include "dispatch.h"
#include "gpu/compute_pipeline.h"
#include "passes/gpu_scene.h"
#include "settings.h"

namespace nightcity {

// Reads PushConstants; `constants` are specialization constants 0, 1, 2, ...
gpu::ComputePipeline makePipeline(gpu::Device& device, const char* name,
                                  std::span<const std::uint32_t> spirv,
                                  std::vector<gpu::Binding> bindings,
                                  std::vector<std::uint32_t> constants = {});

// The scene's structure, of passes that send rays.
inline constexpr gpu::Binding kStructureBinding{NIGHTCITY_BINDING_STRUCTURE,
                                                VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1};

// NIGHTCITY_CONSTANT_MEDIA to NIGHTCITY_CONSTANT_LIT.
std::vector<std::uint32_t> modelConstants(const Model& model, bool media);

// kEmitterIsotropic and so on.
std::uint32_t emitterConstant(Emitter emitter);

// Settings that pipelines are specialised to.
struct PipelineChoice {
    Method method = Method::march;
    bool media = true;
    std::uint32_t task = kTaskRecords;  // of surface.comp; of others there is no other pass
    std::uint32_t aovs = kAllAovs;      // images that are written, sums among them
    // Of the march:
    MarchOrder order = MarchOrder::lights;
    LightPages lights;
    std::uint32_t subdivisions = 25;
    // Of the path tracer, of gauss, and of the field where surfaces are lit:
    Model model;
    bool uniformHaze = false;  // scene/uniform_haze.h
    // Of the field:
    NearKinds near;

    bool operator==(const PipelineChoice&) const = default;
    // Whether light comes from the packed lists.
    bool readsPages() const;
    // Whether a pass lights what surface.comp found.
    bool lightsSurfaces() const {
        const bool known = method == Method::gauss || method == Method::field;
        return known && model.surfaces == Surfaces::lit;
    }
};

struct PassPipelines {
    PipelineChoice choice;
    gpu::ComputePipeline surface;
    gpu::ComputePipeline lit;        // with gauss and field and lit surfaces only
    gpu::ComputePipeline traverse;   // with march and gauss and records only
    gpu::ComputePipeline inScatter;  // march, or gauss
    gpu::ComputePipeline path;       // with the path tracer only
    gpu::ComputePipeline mediaIds;   // with the field only
    gpu::ComputePipeline accumulate;  // with records only

    PassPipelines(gpu::Device& device, const PipelineChoice& choice);
    // To be called when the scene's structure or lists were made anew.
    void bind(const GpuScene& scene);
    // Those of the method, in the order of the passes.
    std::vector<const gpu::ComputePipeline*> all() const;

private:
    void makeMarch(gpu::Device& device);
    void makeLit(gpu::Device& device);
    void makeGauss(gpu::Device& device);
    void makePath(gpu::Device& device);
};

}  // namespace nightcity
