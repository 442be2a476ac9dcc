// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/image.h"

#include <bit>
#include <utility>

#include "errors.h"
#include "gpu/result.h"

namespace nightcity::gpu {
namespace {

uint32_t findLocalMemory(const Device& device, uint32_t allowed, const std::string& name) {
    const VkPhysicalDeviceMemoryProperties& memory = device.memory();
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
        if ((allowed >> i & 1u) != 0 &&
            (memory.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) != 0) {
            return i;
        }
    }
    throw DeviceError("no memory of " + device.name() + " suits the image '" + name +
                      "': take another --device, or --primary rays");
}

}  // namespace

Image::Image(Device& device, const std::string& name, VkExtent2D extent, VkFormat format,
             VkImageUsageFlags usage, VkImageAspectFlags aspect)
    : device_(&device) {
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {extent.width, extent.height, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = usage;
    VkImage image = VK_NULL_HANDLE;
    check(vkCreateImage(device.get(), &info, nullptr, &image), "vkCreateImage", name);
    image_ = {device.get(), image};
    device.setName(VK_OBJECT_TYPE_IMAGE, std::bit_cast<uint64_t>(image), name);
    allocate(name);
    createView(name, format, aspect);
}

void Image::allocate(const std::string& name) {
    VkMemoryRequirements requirements{};
    vkGetImageMemoryRequirements(device_->get(), image_.get(), &requirements);
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = requirements.size;
    info.memoryTypeIndex = findLocalMemory(*device_, requirements.memoryTypeBits, name);
    device_->requireRoom(name, requirements.size);
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check(vkAllocateMemory(device_->get(), &info, nullptr, &memory), "vkAllocateMemory", name);
    memory_ = {device_->get(), memory};
    allocated_ = requirements.size;
    device_->ledger().add(name, allocated_);
    name_ = name;
    check(vkBindImageMemory(device_->get(), image_.get(), memory, 0), "vkBindImageMemory", name);
}

void Image::createView(const std::string& name, VkFormat format, VkImageAspectFlags aspect) {
    VkImageViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    info.image = image_.get();
    info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    info.format = format;
    info.subresourceRange = {aspect, 0, 1, 0, 1};
    VkImageView view = VK_NULL_HANDLE;
    check(vkCreateImageView(device_->get(), &info, nullptr, &view), "vkCreateImageView", name);
    view_ = {device_->get(), view};
}

Image::Image(Image&& other) noexcept {
    *this = std::move(other);
}

Image& Image::operator=(Image&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(memory_, other.memory_);
    std::swap(image_, other.image_);
    std::swap(view_, other.view_);
    std::swap(name_, other.name_);
    std::swap(allocated_, other.allocated_);
    return *this;
}

Image::~Image() {
    if (device_ != nullptr) {
        device_->ledger().remove(name_, allocated_);
    }
}

}  // namespace nightcity::gpu
