// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/buffer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "errors.h"
#include "gpu/result.h"

namespace nightcity::gpu {
namespace {

std::string mebibytes(uint64_t bytes) {
    return std::to_string((bytes + (1u << 20) - 1) >> 20) + " MiB";
}

// The property flags to look for, best first.
std::array<VkMemoryPropertyFlags, 2> preferredMemory(const Device& device, MemoryKind kind) {
    constexpr VkMemoryPropertyFlags kHost =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    switch (kind) {
        case MemoryKind::device:
            return {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | (device.unifiedMemory() ? kHost : 0u),
                    VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT};
        case MemoryKind::upload:
            return {kHost, kHost};
        case MemoryKind::readback:
            break;
    }
    return {kHost | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, kHost};
}

uint32_t findMemoryType(const Device& device, uint32_t allowed, MemoryKind kind,
                        const std::string& name) {
    const VkPhysicalDeviceMemoryProperties& memory = device.memory();
    for (VkMemoryPropertyFlags flags : preferredMemory(device, kind)) {
        for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
            if ((allowed >> i & 1u) != 0 &&
                (memory.memoryTypes[i].propertyFlags & flags) == flags) {
                return i;
            }
        }
    }
    throw DeviceError("no memory of " + device.name() + " suits the buffer '" + name +
                      "': take another --device");
}

}  // namespace

Buffer::Buffer(Device& device, const std::string& name, uint64_t bytes, MemoryKind kind,
               VkBufferUsageFlags usage)
    : device_(&device), bytes_(std::max<uint64_t>(bytes, 16)) {
    if (bytes_ > device.limits().allocationBytes) {
        throw DeviceError("the buffer '" + name + "' takes " + mebibytes(bytes_) + ", but " +
                          device.name() + " allocates at most " +
                          mebibytes(device.limits().allocationBytes) +
                          " at a time: render a smaller part, or take another --device");
    }
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes_;
    info.usage = usage | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    check(vkCreateBuffer(device.get(), &info, nullptr, &buffer), "vkCreateBuffer",
          name + ", " + mebibytes(bytes_));
    buffer_ = {device.get(), buffer};
    device.setName(VK_OBJECT_TYPE_BUFFER, std::bit_cast<uint64_t>(buffer), name);
    allocate(name, kind);
    VkBufferDeviceAddressInfo address{};
    address.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    address.buffer = buffer;
    address_ = vkGetBufferDeviceAddress(device.get(), &address);
}

void Buffer::allocate(const std::string& name, MemoryKind kind) {
    VkMemoryRequirements requirements{};
    vkGetBufferMemoryRequirements(device_->get(), buffer_.get(), &requirements);
    const uint32_t type = findMemoryType(*device_, requirements.memoryTypeBits, kind, name);
    const VkMemoryType& properties = device_->memory().memoryTypes[type];
    const uint64_t heap = device_->memory().memoryHeaps[properties.heapIndex].size;
    if (requirements.size > heap) {
        throw DeviceError("the buffer '" + name + "' takes " + mebibytes(requirements.size) +
                          ", but the memory of " + device_->name() + " is " + mebibytes(heap) +
                          ": render a smaller part, or take another --device");
    }
    VkMemoryAllocateFlagsInfo flags{};
    flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.pNext = &flags;
    info.allocationSize = requirements.size;
    info.memoryTypeIndex = type;
    device_->requireRoom(name, requirements.size);
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check(vkAllocateMemory(device_->get(), &info, nullptr, &memory), "vkAllocateMemory",
          name + ", " + mebibytes(requirements.size));
    memory_ = {device_->get(), memory};
    allocated_ = requirements.size;
    device_->ledger().add(name, allocated_);
    name_ = name;
    check(vkBindBufferMemory(device_->get(), buffer_.get(), memory, 0), "vkBindBufferMemory",
          name);
    constexpr VkMemoryPropertyFlags kHost =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const bool reachable = (properties.propertyFlags & kHost) == kHost;
    if (reachable && (kind != MemoryKind::device || device_->unifiedMemory())) {
        check(vkMapMemory(device_->get(), memory, 0, VK_WHOLE_SIZE, 0, &mapped_), "vkMapMemory",
              name);
        hostCached_ = (properties.propertyFlags & VK_MEMORY_PROPERTY_HOST_CACHED_BIT) != 0;
    }
}

Buffer::Buffer(Buffer&& other) noexcept {
    *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(bytes_, other.bytes_);
    std::swap(name_, other.name_);
    std::swap(allocated_, other.allocated_);
    std::swap(address_, other.address_);
    std::swap(mapped_, other.mapped_);
    std::swap(hostCached_, other.hostCached_);
    std::swap(buffer_, other.buffer_);
    std::swap(memory_, other.memory_);
    return *this;
}

Buffer::~Buffer() {
    if (device_ != nullptr) {
        device_->ledger().remove(name_, allocated_);
    }
}

}  // namespace nightcity::gpu
