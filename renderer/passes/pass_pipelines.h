// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The compute pipelines of a frame, made for one choice of settings.
#pragma once

#include "gpu/compute_pipeline.h"
#include "passes/gpu_scene.h"
#include "settings.h"

namespace nightcity {

// Settings that pipelines are specialised to.
struct PipelineChoice {
    MarchOrder order = MarchOrder::lights;
    LightPages lights;
    std::uint32_t subdivisions = 25;
    bool media = true;

    bool operator==(const PipelineChoice&) const = default;
};

struct PassPipelines {
    PipelineChoice choice;
    gpu::ComputePipeline surface;
    gpu::ComputePipeline traverse;
    gpu::ComputePipeline march;
    gpu::ComputePipeline accumulate;

    PassPipelines(gpu::Device& device, const PipelineChoice& choice);
    // To be called when the scene's structure or lists were made anew.
    void bind(const GpuScene& scene);
};

}  // namespace nightcity
