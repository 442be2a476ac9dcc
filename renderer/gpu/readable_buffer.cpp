// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/readable_buffer.h"

#include "gpu/commands.h"

namespace nightcity::gpu {

ReadableBuffer::ReadableBuffer(Device& device, const std::string& name, uint64_t bytes)
    : buffer_(device, name, bytes, MemoryKind::device) {
    if (!buffer_.hostCached()) {
        copy_ = Buffer(device, name + " on the host", bytes, MemoryKind::readback);
    }
}

void ReadableBuffer::recordReadback(VkCommandBuffer commands) const {
    if (copy_) {
        const VkBufferCopy all{0, 0, buffer_.bytes()};
        vkCmdCopyBuffer(commands, buffer_.get(), copy_.get(), 1, &all);
    }
    hostReadBarrier(commands);
}

const void* ReadableBuffer::data() const {
    return copy_ ? copy_.mapped() : buffer_.mapped();
}

}  // namespace nightcity::gpu
