// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The triangle that every pixel of a frame sees, by rasterisation: a proposal
// that surface.comp tests against the pixel's own ray.
#pragma once

#include <cstdint>

#include "gpu/raster_pipeline.h"
#include "gpu/raster_target.h"
#include "passes/gpu_scene.h"
#include "passes/triangle_chunks.h"

namespace nightcity {

class TriangleRaster {
public:
    explicit TriangleRaster(gpu::Device& device);

    // Whether the device can, and the scene and the frame are within its limits.
    bool serves(const GpuScene& scene, std::uint32_t width, std::uint32_t height) const;
    // To be called before a frame of that size; returns the address of its proposals: uint, a
    // triangle or kNone, one a pixel of the frame, row by row.
    uvec2 prepare(std::uint32_t width, std::uint32_t height);
    // Fills the proposals of whole rows for the sample push.sampleIndex of the frame table that
    // `push` names. `camera`: of that table; `margin`: as visibleRuns() has it. A compute
    // barrier must follow.
    void record(VkCommandBuffer commands, const GpuScene& scene, const PushConstants& push,
                const CameraFrame& camera, const FrameRows& rows, float margin) const;

private:
    gpu::Device& device_;
    gpu::RasterPipeline pipeline_;  // made for the first frame
    gpu::RasterTarget target_;
};

}  // namespace nightcity
