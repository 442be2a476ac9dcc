// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// A graphics pipeline that draws indexed triangles into one image of numbers,
// nearest first by reverse-Z depth: the greatest z / w wins, and both faces count.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace nightcity::gpu {

inline constexpr VkFormat kNumberFormat = VK_FORMAT_R32_UINT;
inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
inline constexpr uint32_t kDrawnVertices = 1u << 24;  // that every device's draws can reach

struct RasterPipelineInfo {
    std::string name;
    std::span<const uint32_t> vertexSpirv;    // location 0: the position, 3 floats
    std::span<const uint32_t> fragmentSpirv;  // location 0: the number
    uint32_t pushConstantBytes = 0;           // of the vertex shader
};

class RasterPipeline {
public:
    RasterPipeline() = default;
    // The device must lack nothing that missingForRaster() names.
    RasterPipeline(Device& device, const RasterPipelineInfo& info);

    VkRenderPass renderPass() const { return renderPass_.get(); }
    void bind(VkCommandBuffer commands, const void* pushConstants) const;

private:
    void createRenderPass(Device& device, const std::string& name);
    void createLayout(Device& device, const RasterPipelineInfo& info);
    void createPipeline(Device& device, const RasterPipelineInfo& info);

    Handle<VkRenderPass, vkDestroyRenderPass> renderPass_;
    Handle<VkPipelineLayout, vkDestroyPipelineLayout> layout_;
    Handle<VkPipeline, vkDestroyPipeline> pipeline_;
    uint32_t pushConstantBytes_ = 0;
};

}  // namespace nightcity::gpu
