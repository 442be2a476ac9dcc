// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// A move-only owner of one Vulkan object that a device made.
#pragma once

#include <utility>

#include <vulkan/vulkan.h>

namespace nightcity::gpu {

template <typename T, auto Destroy>
class Handle {
public:
    Handle() = default;
    Handle(VkDevice device, T object) : device_(device), object_(object) {}
    Handle(Handle&& other) noexcept { swap(other); }
    Handle& operator=(Handle&& other) noexcept {
        Handle moved(std::move(other));
        swap(moved);
        return *this;
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() {
        if (object_ != VK_NULL_HANDLE) {
            Destroy(device_, object_, nullptr);
        }
    }

    T get() const { return object_; }
    VkDevice device() const { return device_; }

private:
    void swap(Handle& other) {
        std::swap(device_, other.device_);
        std::swap(object_, other.object_);
    }

    VkDevice device_ = VK_NULL_HANDLE;
    T object_ = VK_NULL_HANDLE;
};

}  // namespace nightcity::gpu
