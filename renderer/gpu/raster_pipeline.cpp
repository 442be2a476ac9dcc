// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/raster_pipeline.h"

#include <array>
#include <bit>

#include "gpu/result.h"

namespace nightcity::gpu {
namespace {

using ShaderModule = Handle<VkShaderModule, vkDestroyShaderModule>;

ShaderModule makeModule(Device& device, std::span<const uint32_t> spirv, const std::string& name) {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = spirv.size_bytes();
    info.pCode = spirv.data();
    VkShaderModule handle = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device.get(), &info, nullptr, &handle), "vkCreateShaderModule",
          name);
    return {device.get(), handle};
}

VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits which, const ShaderModule& shader) {
    VkPipelineShaderStageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage = which;
    info.module = shader.get();
    info.pName = "main";
    return info;
}

VkAttachmentDescription attachment(VkFormat format, VkAttachmentStoreOp store,
                                   VkImageLayout after) {
    VkAttachmentDescription description{};
    description.format = format;
    description.samples = VK_SAMPLE_COUNT_1_BIT;
    description.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    description.storeOp = store;
    description.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    description.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    description.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    description.finalLayout = after;
    return description;
}

// Vertices and tables that were uploaded are seen by the pass, and it waits for the copy and
// the depth tests of the pass before; its numbers are seen by the copy that follows.
std::array<VkSubpassDependency, 2> dependencies() {
    constexpr VkPipelineStageFlags kAttachments = VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                                  VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT |
                                                  VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    VkSubpassDependency before{};
    before.srcSubpass = VK_SUBPASS_EXTERNAL;
    before.srcStageMask =
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT | kAttachments;
    before.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT |
                           VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT |
                           VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    before.dstStageMask = VK_PIPELINE_STAGE_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_VERTEX_SHADER_BIT |
                          kAttachments;
    before.dstAccessMask =
        VK_ACCESS_INDEX_READ_BIT | VK_ACCESS_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_SHADER_READ_BIT |
        VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
        VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    VkSubpassDependency after{};
    after.dstSubpass = VK_SUBPASS_EXTERNAL;
    after.srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    after.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    after.dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT;
    after.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
    return {before, after};
}

}  // namespace

RasterPipeline::RasterPipeline(Device& device, const RasterPipelineInfo& info)
    : pushConstantBytes_(info.pushConstantBytes) {
    createRenderPass(device, info.name);
    createLayout(device, info);
    createPipeline(device, info);
}

void RasterPipeline::createRenderPass(Device& device, const std::string& name) {
    const VkAttachmentDescription attachments[] = {
        attachment(kNumberFormat, VK_ATTACHMENT_STORE_OP_STORE,
                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL),
        attachment(kDepthFormat, VK_ATTACHMENT_STORE_OP_DONT_CARE,
                   VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL)};
    const VkAttachmentReference number{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &number;
    subpass.pDepthStencilAttachment = &depth;
    const std::array<VkSubpassDependency, 2> around = dependencies();
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = 2;
    info.pAttachments = attachments;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    info.dependencyCount = static_cast<uint32_t>(around.size());
    info.pDependencies = around.data();
    VkRenderPass renderPass = VK_NULL_HANDLE;
    check(vkCreateRenderPass(device.get(), &info, nullptr, &renderPass), "vkCreateRenderPass",
          name);
    renderPass_ = {device.get(), renderPass};
}

void RasterPipeline::createLayout(Device& device, const RasterPipelineInfo& info) {
    const VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT, 0, info.pushConstantBytes};
    VkPipelineLayoutCreateInfo layout{};
    layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout.pushConstantRangeCount = info.pushConstantBytes > 0 ? 1 : 0;
    layout.pPushConstantRanges = &range;
    VkPipelineLayout handle = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(device.get(), &layout, nullptr, &handle),
          "vkCreatePipelineLayout", info.name);
    layout_ = {device.get(), handle};
}

void RasterPipeline::createPipeline(Device& device, const RasterPipelineInfo& info) {
    const ShaderModule vertexShader = makeModule(device, info.vertexSpirv, info.name);
    const ShaderModule fragmentShader = makeModule(device, info.fragmentSpirv, info.name);
    const VkPipelineShaderStageCreateInfo stages[] = {
        stage(VK_SHADER_STAGE_VERTEX_BIT, vertexShader),
        stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragmentShader)};
    const VkVertexInputBindingDescription binding{0, 12, VK_VERTEX_INPUT_RATE_VERTEX};
    const VkVertexInputAttributeDescription position{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0};
    VkPipelineVertexInputStateCreateInfo vertices{};
    vertices.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    vertices.vertexBindingDescriptionCount = 1;
    vertices.pVertexBindingDescriptions = &binding;
    vertices.vertexAttributeDescriptionCount = 1;
    vertices.pVertexAttributeDescriptions = &position;
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{};
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = 1;
    viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo rasterization{};
    rasterization.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    rasterization.polygonMode = VK_POLYGON_MODE_FILL;
    rasterization.cullMode = VK_CULL_MODE_NONE;
    rasterization.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples{};
    samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = VK_TRUE;
    depth.depthWriteEnable = VK_TRUE;
    depth.depthCompareOp = VK_COMPARE_OP_GREATER;
    VkPipelineColorBlendAttachmentState write{};
    write.colorWriteMask = VK_COLOR_COMPONENT_R_BIT;
    VkPipelineColorBlendStateCreateInfo blend{};
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = 1;
    blend.pAttachments = &write;
    const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{};
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = states;

    VkGraphicsPipelineCreateInfo pipeline{};
    pipeline.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    pipeline.stageCount = 2;
    pipeline.pStages = stages;
    pipeline.pVertexInputState = &vertices;
    pipeline.pInputAssemblyState = &assembly;
    pipeline.pViewportState = &viewport;
    pipeline.pRasterizationState = &rasterization;
    pipeline.pMultisampleState = &samples;
    pipeline.pDepthStencilState = &depth;
    pipeline.pColorBlendState = &blend;
    pipeline.pDynamicState = &dynamic;
    pipeline.layout = layout_.get();
    pipeline.renderPass = renderPass_.get();
    VkPipeline handle = VK_NULL_HANDLE;
    check(vkCreateGraphicsPipelines(device.get(), VK_NULL_HANDLE, 1, &pipeline, nullptr, &handle),
          "vkCreateGraphicsPipelines", info.name);
    pipeline_ = {device.get(), handle};
    device.setName(VK_OBJECT_TYPE_PIPELINE, std::bit_cast<uint64_t>(handle), info.name);
}

void RasterPipeline::bind(VkCommandBuffer commands, const void* pushConstants) const {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.get());
    if (pushConstantBytes_ > 0) {
        vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_VERTEX_BIT, 0,
                           pushConstantBytes_, pushConstants);
    }
}

}  // namespace nightcity::gpu
