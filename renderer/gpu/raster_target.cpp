// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/raster_target.h"

#include "gpu/result.h"

namespace nightcity::gpu {

RasterTarget::RasterTarget(Device& device, const RasterPipeline& pipeline, VkExtent2D extent)
    : extent_(extent),
      numberImage_(device, "triangle numbers", extent, kNumberFormat,
                   VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                   VK_IMAGE_ASPECT_COLOR_BIT),
      depthImage_(device, "depths", extent, kDepthFormat,
                  VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_ASPECT_DEPTH_BIT),
      numbers_(device, "triangle numbers", uint64_t{extent.width} * extent.height * 4,
               MemoryKind::device) {
    const VkImageView views[] = {numberImage_.view(), depthImage_.view()};
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = pipeline.renderPass();
    info.attachmentCount = 2;
    info.pAttachments = views;
    info.width = extent.width;
    info.height = extent.height;
    info.layers = 1;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    check(vkCreateFramebuffer(device.get(), &info, nullptr, &framebuffer), "vkCreateFramebuffer",
          "triangle numbers");
    framebuffer_ = {device.get(), framebuffer};
}

void RasterTarget::record(VkCommandBuffer commands, const RasterPipeline& pipeline,
                          uint32_t firstRow, uint32_t rows, uint32_t clear,
                          const std::function<void()>& draw) const {
    const VkRect2D area{{0, static_cast<int32_t>(firstRow)}, {extent_.width, rows}};
    VkClearValue clears[2]{};
    clears[0].color.uint32[0] = clear;
    clears[1].depthStencil.depth = 0;
    VkRenderPassBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    begin.renderPass = pipeline.renderPass();
    begin.framebuffer = framebuffer_.get();
    begin.renderArea = area;
    begin.clearValueCount = 2;
    begin.pClearValues = clears;
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    const VkViewport viewport{
        0, 0, static_cast<float>(extent_.width), static_cast<float>(extent_.height), 0, 1};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &area);
    draw();
    vkCmdEndRenderPass(commands);
    recordCopy(commands, firstRow, rows);
}

void RasterTarget::recordCopy(VkCommandBuffer commands, uint32_t firstRow, uint32_t rows) const {
    VkBufferImageCopy region{};
    region.bufferOffset = uint64_t{firstRow} * extent_.width * 4;
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageOffset = {0, static_cast<int32_t>(firstRow), 0};
    region.imageExtent = {extent_.width, rows, 1};
    vkCmdCopyImageToBuffer(commands, numberImage_.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           numbers_.get(), 1, &region);
}

}  // namespace nightcity::gpu
