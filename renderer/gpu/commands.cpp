// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/commands.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#include "gpu/result.h"

namespace nightcity::gpu {
namespace {

constexpr uint64_t kStagingBytes = 16u << 20;

void memoryBarrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags written,
                   VkPipelineStageFlags to, VkAccessFlags read) {
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = written;
    barrier.dstAccessMask = read;
    vkCmdPipelineBarrier(commands, from, to, 0, 1, &barrier, 0, nullptr, 0, nullptr);
}

}  // namespace

Commands::Commands(Device& device) : device_(device) {
    VkCommandPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = device.queueFamily();
    VkCommandPool poolHandle = VK_NULL_HANDLE;
    check(vkCreateCommandPool(device.get(), &pool, nullptr, &poolHandle), "vkCreateCommandPool");
    pool_ = {device.get(), poolHandle};

    VkCommandBufferAllocateInfo buffer{};
    buffer.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    buffer.commandPool = poolHandle;
    buffer.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    buffer.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device.get(), &buffer, &buffer_), "vkAllocateCommandBuffers");

    VkFenceCreateInfo fence{};
    fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VkFence fenceHandle = VK_NULL_HANDLE;
    check(vkCreateFence(device.get(), &fence, nullptr, &fenceHandle), "vkCreateFence");
    fence_ = {device.get(), fenceHandle};
}

double Commands::run(const char* what, const std::function<void(VkCommandBuffer)>& record) {
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(buffer_, &begin), "vkBeginCommandBuffer", what);
    record(buffer_);
    check(vkEndCommandBuffer(buffer_), "vkEndCommandBuffer", what);

    VkFence fence = fence_.get();
    check(vkResetFences(device_.get(), 1, &fence), "vkResetFences", what);
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &buffer_;
    const auto start = std::chrono::steady_clock::now();
    check(vkQueueSubmit(device_.queue(), 1, &submit, fence), "vkQueueSubmit", what);
    check(vkWaitForFences(device_.get(), 1, &fence, VK_TRUE, UINT64_MAX), "vkWaitForFences",
          what);
    const std::chrono::duration<double, std::milli> wall =
        std::chrono::steady_clock::now() - start;
    return wall.count();
}

void Commands::upload(Buffer& target, const void* data, uint64_t bytes, uint64_t offset) {
    if (bytes == 0) {
        return;
    }
    if (target.mapped() != nullptr) {
        std::memcpy(static_cast<char*>(target.mapped()) + offset, data, bytes);
        return;
    }
    if (!staging_) {
        staging_ = Buffer(device_, "staging", kStagingBytes, MemoryKind::upload);
    }
    for (uint64_t done = 0; done < bytes; done += kStagingBytes) {
        const uint64_t piece = std::min(kStagingBytes, bytes - done);
        std::memcpy(staging_.mapped(), static_cast<const char*>(data) + done, piece);
        run("upload", [&](VkCommandBuffer commands) {
            const VkBufferCopy copy{0, offset + done, piece};
            vkCmdCopyBuffer(commands, staging_.get(), target.get(), 1, &copy);
            computeBarrier(commands);
        });
    }
}

void computeBarrier(VkCommandBuffer commands) {
    constexpr VkPipelineStageFlags kStages =
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT |
        VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
    constexpr VkAccessFlags kWrites = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT |
                                      VK_ACCESS_ACCELERATION_STRUCTURE_WRITE_BIT_KHR;
    constexpr VkAccessFlags kReads =
        VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_UNIFORM_READ_BIT |
        VK_ACCESS_ACCELERATION_STRUCTURE_READ_BIT_KHR;
    memoryBarrier(commands, kStages, kWrites, kStages, kReads | kWrites);
}

void hostReadBarrier(VkCommandBuffer commands) {
    memoryBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
}

}  // namespace nightcity::gpu
