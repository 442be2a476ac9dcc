// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/triangle_raster.h"

#include "number_spirv.h"
#include "projection_spirv.h"

namespace nightcity {

TriangleRaster::TriangleRaster(gpu::Device& device) : device_(device) {}

bool TriangleRaster::serves(const GpuScene& scene, std::uint32_t width,
                            std::uint32_t height) const {
    const std::uint32_t side = device_.limits().rasterSide;
    return device_.missingForRaster().empty() && width <= side && height <= side &&
           scene.vertexCount() <= gpu::kDrawnVertices;
}

uvec2 TriangleRaster::prepare(std::uint32_t width, std::uint32_t height) {
    if (pipeline_.renderPass() == VK_NULL_HANDLE) {
        gpu::RasterPipelineInfo info;
        info.name = "raster";
        info.vertexSpirv = kProjectionSpirv;
        info.fragmentSpirv = kNumberSpirv;
        info.pushConstantBytes = sizeof(PushConstants);
        pipeline_ = {device_, info};
    }
    if (target_.extent().width != width || target_.extent().height != height) {
        target_ = {};
        target_ = {device_, pipeline_, {width, height}};
    }
    return addressWords(target_.numbers());
}

void TriangleRaster::record(VkCommandBuffer commands, const GpuScene& scene,
                            const PushConstants& push, const CameraFrame& camera,
                            const FrameRows& rows, float margin) const {
    target_.record(commands, pipeline_, rows.first, rows.count, kNone, [&] {
        pipeline_.bind(commands, &push);
        const VkBuffer positions = scene.positions();
        const VkDeviceSize start = 0;
        vkCmdBindVertexBuffers(commands, 0, 1, &positions, &start);
        vkCmdBindIndexBuffer(commands, scene.triangleIndices(), 0, VK_INDEX_TYPE_UINT32);
        for (const TriangleRun& run : visibleRuns(scene.chunks(), camera, rows, margin)) {
            // The first instance tells the shaders the number of the first triangle.
            vkCmdDrawIndexed(commands, run.count * 3, 1, run.first * 3, 0, run.first);
        }
    });
}

}  // namespace nightcity
