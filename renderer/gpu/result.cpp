// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/result.h"

#include "errors.h"

namespace nightcity::gpu {

std::string resultName(VkResult result) {
    switch (result) {
#define NIGHTCITY_RESULT(name) \
    case name:                 \
        return #name;
        NIGHTCITY_RESULT(VK_SUCCESS)
        NIGHTCITY_RESULT(VK_NOT_READY)
        NIGHTCITY_RESULT(VK_TIMEOUT)
        NIGHTCITY_RESULT(VK_INCOMPLETE)
        NIGHTCITY_RESULT(VK_ERROR_OUT_OF_HOST_MEMORY)
        NIGHTCITY_RESULT(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        NIGHTCITY_RESULT(VK_ERROR_INITIALIZATION_FAILED)
        NIGHTCITY_RESULT(VK_ERROR_DEVICE_LOST)
        NIGHTCITY_RESULT(VK_ERROR_MEMORY_MAP_FAILED)
        NIGHTCITY_RESULT(VK_ERROR_LAYER_NOT_PRESENT)
        NIGHTCITY_RESULT(VK_ERROR_EXTENSION_NOT_PRESENT)
        NIGHTCITY_RESULT(VK_ERROR_FEATURE_NOT_PRESENT)
        NIGHTCITY_RESULT(VK_ERROR_INCOMPATIBLE_DRIVER)
        NIGHTCITY_RESULT(VK_ERROR_TOO_MANY_OBJECTS)
        NIGHTCITY_RESULT(VK_ERROR_FRAGMENTED_POOL)
        NIGHTCITY_RESULT(VK_ERROR_OUT_OF_POOL_MEMORY)
        NIGHTCITY_RESULT(VK_ERROR_UNKNOWN)
#undef NIGHTCITY_RESULT
        default:
            return "VkResult " + std::to_string(static_cast<int>(result));
    }
}

void check(VkResult result, std::string_view call, std::string_view purpose) {
    if (result == VK_SUCCESS) {
        return;
    }
    std::string message(call);
    if (!purpose.empty()) {
        message += " (" + std::string(purpose) + ")";
    }
    message += " failed: " + resultName(result);
    if (result == VK_ERROR_DEVICE_LOST) {
        message += "; the driver reset the device: try again, or another --device";
    } else if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) {
        message += "; close other programs that use the device, or take another --device";
    }
    throw DeviceError(message);
}

}  // namespace nightcity::gpu
