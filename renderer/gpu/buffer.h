// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// A buffer with its own memory.
#pragma once

#include <cstdint>
#include <string>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace nightcity::gpu {

enum class MemoryKind {
    device,    // the device's own; mapped only where memory is unified
    upload,    // the host writes, the device reads
    readback,  // the device writes, the host reads
};

class Buffer {
public:
    Buffer() = default;
    // Every buffer has a device address; `usage` adds to that and to storage and transfer.
    // Throws DeviceError naming the buffer, its size and the limit that it passes. At least one
    // byte is allocated, so that an empty array still has an address.
    Buffer(Device& device, const std::string& name, uint64_t bytes, MemoryKind kind,
           VkBufferUsageFlags usage = 0);
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;
    ~Buffer();

    VkBuffer get() const { return buffer_.get(); }
    uint64_t bytes() const { return bytes_; }
    VkDeviceAddress address() const { return address_; }
    void* mapped() const { return mapped_; }  // nullptr where the host can't reach it
    bool hostCached() const { return hostCached_; }  // mapped, and fast to read
    explicit operator bool() const { return buffer_.get() != VK_NULL_HANDLE; }

private:
    void allocate(const std::string& name, MemoryKind kind);

    Device* device_ = nullptr;
    Handle<VkDeviceMemory, vkFreeMemory> memory_;  // outlives the buffer bound to it
    Handle<VkBuffer, vkDestroyBuffer> buffer_;
    uint64_t bytes_ = 0;
    std::string name_;
    uint64_t allocated_ = 0;
    VkDeviceAddress address_ = 0;
    void* mapped_ = nullptr;
    bool hostCached_ = false;
};

}  // namespace nightcity::gpu
