// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Every Vulkan call that can fail goes through check().
#pragma once

#include <string>
#include <string_view>

#include <vulkan/vulkan.h>

namespace nightcity::gpu {

// "VK_ERROR_DEVICE_LOST", or the number of a result that this table lacks.
std::string resultName(VkResult result);

// Throws DeviceError naming the call, what it was for, and the result, unless it is VK_SUCCESS.
void check(VkResult result, std::string_view call, std::string_view purpose = {});

}  // namespace nightcity::gpu
