// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// A two-dimensional image with its own memory and one view of all of it.
#pragma once

#include <cstdint>
#include <string>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace nightcity::gpu {

class Image {
public:
    Image() = default;
    // Of the device's own memory. Throws DeviceError naming the image.
    Image(Device& device, const std::string& name, VkExtent2D extent, VkFormat format,
          VkImageUsageFlags usage, VkImageAspectFlags aspect);
    Image(Image&& other) noexcept;
    Image& operator=(Image&& other) noexcept;
    Image(const Image&) = delete;
    Image& operator=(const Image&) = delete;
    ~Image();

    VkImage get() const { return image_.get(); }
    VkImageView view() const { return view_.get(); }

private:
    void allocate(const std::string& name);
    void createView(const std::string& name, VkFormat format, VkImageAspectFlags aspect);

    Device* device_ = nullptr;
    Handle<VkDeviceMemory, vkFreeMemory> memory_;  // outlives the image bound to it
    Handle<VkImage, vkDestroyImage> image_;
    Handle<VkImageView, vkDestroyImageView> view_;
    std::string name_;
    uint64_t allocated_ = 0;
};

}  // namespace nightcity::gpu
