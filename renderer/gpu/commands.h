// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Records commands, submits them and waits: one batch at a time.
#pragma once

#include <functional>

#include "gpu/buffer.h"
#include "gpu/device.h"
#include "gpu/handle.h"

namespace nightcity::gpu {

class Commands {
public:
    explicit Commands(Device& device);

    // Records with `record`, submits, waits for the device. Returns the milliseconds from
    // submission to the fence. `what` names the work in errors.
    double run(const char* what, const std::function<void(VkCommandBuffer)>& record);

    // Fills `target` from the host: in place where it is mapped, else through a staging buffer,
    // in pieces of at most 16 MiB. `offset`: into the target, bytes.
    void upload(Buffer& target, const void* data, uint64_t bytes, uint64_t offset = 0);

private:
    Device& device_;
    Handle<VkCommandPool, vkDestroyCommandPool> pool_;
    Handle<VkFence, vkDestroyFence> fence_;
    VkCommandBuffer buffer_ = VK_NULL_HANDLE;  // freed with the pool
    Buffer staging_;
};

// Everything that shaders and builds wrote before is seen by the shaders, builds, copies and
// indirect dispatches that follow.
void computeBarrier(VkCommandBuffer commands);

// What shaders and copies wrote is seen by the host once the fence has signalled.
void hostReadBarrier(VkCommandBuffer commands);

}  // namespace nightcity::gpu
