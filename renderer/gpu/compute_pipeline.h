// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// A compute pipeline with one descriptor set and one block of push constants.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/device.h"
#include "gpu/handle.h"

namespace nightcity::gpu {

// One binding of the set: an acceleration structure, or an array of buffers.
struct Binding {
    uint32_t index = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    uint32_t count = 1;
};

struct ComputePipelineInfo {
    std::string name;
    std::span<const uint32_t> spirv;
    std::vector<Binding> bindings;
    uint32_t pushConstantBytes = 0;
    std::vector<uint32_t> constants;  // specialization constants 0, 1, 2, ...
};

class ComputePipeline {
public:
    ComputePipeline() = default;
    ComputePipeline(Device& device, const ComputePipelineInfo& info);

    void bindAccelerationStructure(uint32_t binding, VkAccelerationStructureKHR structure);
    // An array of buffers that are pieces of one: element i is piece i of `bytesEach` bytes,
    // the last one cut where the buffer ends.
    void bindBuffers(const Binding& binding, const Buffer& buffer, uint64_t bytesEach);

    void dispatch(VkCommandBuffer commands, const void* pushConstants, uint32_t groups) const;

private:
    void createLayout(Device& device, const ComputePipelineInfo& info);
    void createSet(Device& device, const ComputePipelineInfo& info);
    void createPipeline(Device& device, const ComputePipelineInfo& info);
    void bind(VkCommandBuffer commands, const void* pushConstants) const;

    Handle<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout> setLayout_;
    Handle<VkPipelineLayout, vkDestroyPipelineLayout> layout_;
    Handle<VkDescriptorPool, vkDestroyDescriptorPool> pool_;
    Handle<VkPipeline, vkDestroyPipeline> pipeline_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;  // freed with the pool; null without bindings
    uint32_t pushConstantBytes_ = 0;
};

}  // namespace nightcity::gpu
