// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// A buffer of the device that the host reads after a batch: in place where its
// memory is mapped and cached, else through a copy.
#pragma once

#include <string>

#include "gpu/buffer.h"

namespace nightcity::gpu {

class ReadableBuffer {
public:
    ReadableBuffer() = default;
    ReadableBuffer(Device& device, const std::string& name, uint64_t bytes);

    const Buffer& buffer() const { return buffer_; }
    uint64_t bytes() const { return buffer_.bytes(); }
    // Records what makes the shaders' writes readable once the batch is done. To be recorded
    // after a compute barrier.
    void recordReadback(VkCommandBuffer commands) const;
    const void* data() const;

private:
    Buffer buffer_;
    Buffer copy_;  // empty where buffer_ itself can be read
};

}  // namespace nightcity::gpu
