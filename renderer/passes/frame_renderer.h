// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Renders a frame band by band: raster and surface, and its light; traverse and march or
// gauss, or path; accumulate. Or raster, surface and the passes of glow_passes.h. Without haze the
// surface pass writes the images itself.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "frame.h"
#include "gpu/commands.h"
#include "gpu/timestamps.h"
#include "passes/band_buffers.h"
#include "passes/glow_passes.h"
#include "passes/gpu_scene.h"
#include "passes/pass_pipelines.h"
#include "passes/triangle_raster.h"
#include "settings.h"

namespace nightcity {

// What a rendered frame cost.
struct FrameCost {
    double milliseconds = 0;         // from submissions to fences
    std::vector<PassTime> passes;    // in order; empty where the device has no timestamps
    std::uint64_t lightEvaluations = 0;
};

class FrameRenderer {
public:
    FrameRenderer(gpu::Device& device, gpu::Commands& commands);

    // Of a band, at most: what its records are made for.
    static std::uint64_t mostRays(const RenderProduct& product, Method method);

    // To be called when the scene was synced: pipelines and bindings may be stale.
    void sceneChanged() { bound_ = false; }
    // `camera` as it is at the product's frame. Fills `frame`, which has the product's size;
    // `progress` (share done, 0 to 1) may be empty.
    FrameCost render(const GpuScene& scene, const CameraFrame& camera,
                     const RenderProduct& product, const RenderSettings& settings,
                     const std::function<void(double)>& progress, Frame& frame);

private:
    struct Work;  // one render call
    struct Band;  // pixels that the passes cover at once

    void preparePipelines(const GpuScene& scene, const RenderProduct& product,
                          const RenderSettings& settings);
    void prepareBand(Work& work, const CameraFrame& camera, const RenderProduct& product);
    void warmUp(const GpuScene& scene);
    // Records the pass that finds the surfaces: the raster where it is due, then the rays'.
    void rasterise(Work& work, const PushConstants& push);
    void surfaceSample(Work& work, const PushConstants& push, bool last);
    void tracePaths(Work& work, PushConstants push, const std::function<void(double)>& progress);
    void scatterSample(Work& work, PushConstants push);
    void renderSample(Work& work, const PushConstants& push,
                      const std::function<void(double)>& progress);
    void traceGlow(Work& work, const PushConstants& push, bool last);
    void accumulateSample(Work& work, const PushConstants& push, bool last);
    static std::vector<Band> bandsOf(const RenderProduct& product, Method method);
    void copyBand(const Band& band, const RenderProduct& product, Method method, Frame& frame);
    void dispatch(VkCommandBuffer commands, const char* name, const gpu::ComputePipeline& pipeline,
                  const PushConstants& push);
    void collectTimes(FrameCost& cost, double milliseconds);
    const PassCounters& counters() const;

    gpu::Device& device_;
    gpu::Commands& commands_;
    gpu::Timestamps timestamps_;
    TriangleRaster raster_;
    std::unique_ptr<PassPipelines> pipelines_;
    std::unique_ptr<BandBuffers> band_;
    std::unique_ptr<GlowPasses> glow_;  // from the first frame of --method field on
    bool bound_ = false;
    std::uint64_t copied_ = 0;  // pixels of this frame that are on the host
};

}  // namespace nightcity
