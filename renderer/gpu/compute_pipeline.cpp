// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/compute_pipeline.h"

#include <algorithm>
#include <bit>

#include "gpu/result.h"

namespace nightcity::gpu {

ComputePipeline::ComputePipeline(Device& device, const ComputePipelineInfo& info)
    : pushConstantBytes_(info.pushConstantBytes) {
    createLayout(device, info);
    createSet(device, info);
    createPipeline(device, info);
}

void ComputePipeline::createLayout(Device& device, const ComputePipelineInfo& info) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const Binding& binding : info.bindings) {
        bindings.push_back(
            {binding.index, binding.type, binding.count, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo set{};
    set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set.bindingCount = static_cast<uint32_t>(bindings.size());
    set.pBindings = bindings.data();
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    check(vkCreateDescriptorSetLayout(device.get(), &set, nullptr, &setLayout),
          "vkCreateDescriptorSetLayout", info.name);
    setLayout_ = {device.get(), setLayout};

    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, info.pushConstantBytes};
    VkPipelineLayoutCreateInfo layout{};
    layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &setLayout;
    layout.pushConstantRangeCount = info.pushConstantBytes > 0 ? 1 : 0;
    layout.pPushConstantRanges = &range;
    VkPipelineLayout pipelineLayout = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(device.get(), &layout, nullptr, &pipelineLayout),
          "vkCreatePipelineLayout", info.name);
    layout_ = {device.get(), pipelineLayout};
}

void ComputePipeline::createSet(Device& device, const ComputePipelineInfo& info) {
    if (info.bindings.empty()) {
        return;
    }
    std::vector<VkDescriptorPoolSize> sizes;
    for (const Binding& binding : info.bindings) {
        sizes.push_back({binding.type, binding.count});
    }
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.maxSets = 1;
    pool.poolSizeCount = static_cast<uint32_t>(sizes.size());
    pool.pPoolSizes = sizes.data();
    VkDescriptorPool poolHandle = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device.get(), &pool, nullptr, &poolHandle),
          "vkCreateDescriptorPool", info.name);
    pool_ = {device.get(), poolHandle};

    VkDescriptorSetLayout setLayout = setLayout_.get();
    VkDescriptorSetAllocateInfo set{};
    set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    set.descriptorPool = poolHandle;
    set.descriptorSetCount = 1;
    set.pSetLayouts = &setLayout;
    check(vkAllocateDescriptorSets(device.get(), &set, &set_), "vkAllocateDescriptorSets",
          info.name);
}

void ComputePipeline::createPipeline(Device& device, const ComputePipelineInfo& info) {
    VkShaderModuleCreateInfo module{};
    module.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    module.codeSize = info.spirv.size_bytes();
    module.pCode = info.spirv.data();
    VkShaderModule moduleHandle = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device.get(), &module, nullptr, &moduleHandle),
          "vkCreateShaderModule", info.name);
    const Handle<VkShaderModule, vkDestroyShaderModule> shader(device.get(), moduleHandle);

    std::vector<VkSpecializationMapEntry> entries;
    for (uint32_t i = 0; i < info.constants.size(); ++i) {
        entries.push_back({i, i * 4, 4});
    }
    VkSpecializationInfo specialization{};
    specialization.mapEntryCount = static_cast<uint32_t>(entries.size());
    specialization.pMapEntries = entries.data();
    specialization.dataSize = info.constants.size() * 4;
    specialization.pData = info.constants.data();

    VkComputePipelineCreateInfo pipeline{};
    pipeline.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    pipeline.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    pipeline.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    pipeline.stage.module = moduleHandle;
    pipeline.stage.pName = "main";
    pipeline.stage.pSpecializationInfo = &specialization;
    pipeline.layout = layout_.get();
    VkPipeline pipelineHandle = VK_NULL_HANDLE;
    check(vkCreateComputePipelines(device.get(), VK_NULL_HANDLE, 1, &pipeline, nullptr,
                                   &pipelineHandle),
          "vkCreateComputePipelines", info.name);
    pipeline_ = {device.get(), pipelineHandle};
    device.setName(VK_OBJECT_TYPE_PIPELINE, std::bit_cast<uint64_t>(pipelineHandle), info.name);
}

void ComputePipeline::bindAccelerationStructure(uint32_t binding,
                                                VkAccelerationStructureKHR structure) {
    VkWriteDescriptorSetAccelerationStructureKHR acceleration{};
    acceleration.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR;
    acceleration.accelerationStructureCount = 1;
    acceleration.pAccelerationStructures = &structure;
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.pNext = &acceleration;
    write.dstSet = set_;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
    vkUpdateDescriptorSets(setLayout_.device(), 1, &write, 0, nullptr);
}

void ComputePipeline::bindBuffers(const Binding& binding, const Buffer& buffer,
                                  uint64_t bytesEach) {
    std::vector<VkDescriptorBufferInfo> pieces(binding.count);
    for (uint32_t i = 0; i < binding.count; ++i) {
        const uint64_t first = i * bytesEach;
        pieces[i] = {buffer.get(), first, std::min(bytesEach, buffer.bytes() - first)};
    }
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set_;
    write.dstBinding = binding.index;
    write.descriptorCount = binding.count;
    write.descriptorType = binding.type;
    write.pBufferInfo = pieces.data();
    vkUpdateDescriptorSets(setLayout_.device(), 1, &write, 0, nullptr);
}

void ComputePipeline::bind(VkCommandBuffer commands, const void* pushConstants) const {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    if (set_ != VK_NULL_HANDLE) {
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0, 1,
                                &set_, 0, nullptr);
    }
    if (pushConstantBytes_ > 0) {
        vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           pushConstantBytes_, pushConstants);
    }
}

void ComputePipeline::dispatch(VkCommandBuffer commands, const void* pushConstants,
                               uint32_t groups) const {
    bind(commands, pushConstants);
    vkCmdDispatch(commands, groups, 1, 1);
}

}  // namespace nightcity::gpu
