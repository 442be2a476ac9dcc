// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The Vulkan instance, and the validation messages that it collects.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

namespace nightcity::gpu {

struct MessageLog;

class Instance {
public:
    // With validation: core and synchronization checks, by VK_LAYER_KHRONOS_validation.
    // Throws DeviceError where there is no Vulkan, or no such layer.
    explicit Instance(bool validation);
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;
    ~Instance();  // writes to standard error what no throwIfMessages() has reported

    VkInstance get() const { return instance_; }

    // Throws DeviceError with all validation messages since the last call, if there are any.
    void throwIfMessages();

private:
    void createMessenger();

    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    std::unique_ptr<MessageLog> log_;
};

}  // namespace nightcity::gpu
