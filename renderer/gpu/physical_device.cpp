// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/physical_device.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "errors.h"
#include "gpu/result.h"

namespace nightcity::gpu {
namespace {

constexpr uint32_t kWorkGroup = 256;  // threads, of every pass

std::string join(const std::vector<std::string>& parts, const char* separator) {
    std::string all;
    for (const std::string& part : parts) {
        all += (all.empty() ? "" : separator) + part;
    }
    return all;
}

std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::set<std::string> extensionNames(VkPhysicalDevice device) {
    uint32_t count = 0;
    check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr),
          "vkEnumerateDeviceExtensionProperties");
    std::vector<VkExtensionProperties> extensions(count);
    check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()),
          "vkEnumerateDeviceExtensionProperties");
    std::set<std::string> names;
    for (const VkExtensionProperties& extension : extensions) {
        names.insert(extension.extensionName);
    }
    return names;
}

DeviceFeatures queryFeatures(VkPhysicalDevice device) {
    const std::set<std::string> extensions = extensionNames(device);
    DeviceFeatures features;
    features.accelerationStructureExtension =
        extensions.contains(VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME);
    features.deferredHostOperationsExtension =
        extensions.contains(VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME);
    features.rayQueryExtension = extensions.contains(VK_KHR_RAY_QUERY_EXTENSION_NAME);

    VkPhysicalDeviceRayQueryFeaturesKHR rayQuery{};
    rayQuery.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
    VkPhysicalDeviceAccelerationStructureFeaturesKHR acceleration{};
    acceleration.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
    VkPhysicalDeviceVulkan12Features vulkan12{};
    vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    VkPhysicalDeviceFeatures2 all{};
    all.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    all.pNext = &vulkan12;
    if (features.accelerationStructureExtension) {
        vulkan12.pNext = &acceleration;
    }
    if (features.rayQueryExtension) {
        acceleration.pNext = vulkan12.pNext != nullptr ? &rayQuery : nullptr;
    }
    vkGetPhysicalDeviceFeatures2(device, &all);
    features.accelerationStructure = acceleration.accelerationStructure == VK_TRUE;
    features.rayQuery = rayQuery.rayQuery == VK_TRUE;
    features.bufferDeviceAddress = vulkan12.bufferDeviceAddress == VK_TRUE;
    features.scalarBlockLayout = vulkan12.scalarBlockLayout == VK_TRUE;
    features.uniformArrayDynamicIndexing =
        all.features.shaderUniformBufferArrayDynamicIndexing == VK_TRUE;
    features.uniformArrayNonUniformIndexing =
        vulkan12.shaderUniformBufferArrayNonUniformIndexing == VK_TRUE;
    features.storageArrayDynamicIndexing =
        all.features.shaderStorageBufferArrayDynamicIndexing == VK_TRUE;
    features.storageArrayNonUniformIndexing =
        vulkan12.shaderStorageBufferArrayNonUniformIndexing == VK_TRUE;
    features.geometryShader = all.features.geometryShader == VK_TRUE;
    VkFormatProperties depth{};
    vkGetPhysicalDeviceFormatProperties(device, VK_FORMAT_D32_SFLOAT, &depth);
    features.depth32 =
        (depth.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT) != 0;
    return features;
}

void queryQueue(DeviceDescription& description) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(description.handle, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(description.handle, &count, families.data());
    for (const VkQueueFlags wanted :
         {VkQueueFlags{VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT},
          VkQueueFlags{VK_QUEUE_COMPUTE_BIT}}) {
        for (uint32_t i = 0; i < count; ++i) {
            if ((families[i].queueFlags & wanted) == wanted) {
                description.features.computeQueue = true;
                description.features.graphicsQueue = (wanted & VK_QUEUE_GRAPHICS_BIT) != 0;
                description.queueFamily = i;
                description.timestampBits = families[i].timestampValidBits;
                return;
            }
        }
    }
}

bool hasSubgroupBallot(const VkPhysicalDeviceSubgroupProperties& subgroup) {
    constexpr VkSubgroupFeatureFlags kNeeded = VK_SUBGROUP_FEATURE_BALLOT_BIT |
                                               VK_SUBGROUP_FEATURE_VOTE_BIT |
                                               VK_SUBGROUP_FEATURE_ARITHMETIC_BIT;
    return (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0 &&
           (subgroup.supportedOperations & kNeeded) == kNeeded;
}

DeviceDescription describe(VkPhysicalDevice device) {
    VkPhysicalDeviceDriverProperties driver{};
    driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    VkPhysicalDeviceSubgroupProperties subgroup{};
    subgroup.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
    driver.pNext = &subgroup;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    vkGetPhysicalDeviceProperties(device, &properties.properties);
    DeviceDescription description;
    description.handle = device;
    description.apiVersion = properties.properties.apiVersion;
    if (description.apiVersion >= VK_API_VERSION_1_2) {  // the structures are of 1.2
        properties.pNext = &driver;
        vkGetPhysicalDeviceProperties2(device, &properties);
        description.features = queryFeatures(device);
        description.features.subgroupBallot = hasSubgroupBallot(subgroup);
    }
    description.name = properties.properties.deviceName;
    description.driver = std::string(driver.driverName) + " " + driver.driverInfo;
    description.type = properties.properties.deviceType;
    description.workGroupInvocations =
        properties.properties.limits.maxComputeWorkGroupInvocations;
    queryQueue(description);
    return description;
}

int speedRank(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return 4;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return 3;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return 2;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return 1;
        default:
            return 0;
    }
}

std::string inventory(const std::vector<DeviceDescription>& devices) {
    std::string text;
    for (size_t i = 0; i < devices.size(); ++i) {
        const std::vector<std::string> missing = devices[i].missing();
        text += "\n  " + std::to_string(i) + ": " + devices[i].name + " - " +
                (missing.empty() ? "will do" : "lacks " + join(missing, ", "));
    }
    return text;
}

constexpr const char* kInstead =
    "take another --device, install a software Vulkan driver with ray query (Mesa 24.1 or later, "
    "mesa-vulkan-drivers), or use --method reference, which runs on the CPU";

const DeviceDescription& findWanted(const std::vector<DeviceDescription>& devices,
                                    const std::string& wanted) {
    if (std::all_of(wanted.begin(), wanted.end(),
                    [](unsigned char c) { return std::isdigit(c) != 0; })) {
        if (wanted.size() < 6 && std::stoul(wanted) < devices.size()) {
            return devices[std::stoul(wanted)];
        }
    } else {
        for (const DeviceDescription& device : devices) {
            if (lowerCase(device.name).find(lowerCase(wanted)) != std::string::npos) {
                return device;
            }
        }
    }
    throw DeviceError("--device " + wanted + ": no such device; there are:" + inventory(devices));
}

}  // namespace

std::vector<std::string> DeviceDescription::missing() const {
    std::vector<std::string> lacks;
    const auto need = [&lacks](bool present, const char* name) {
        if (!present) {
            lacks.emplace_back(name);
        }
    };
    need(apiVersion >= VK_API_VERSION_1_2, "Vulkan 1.2");
    need(features.rayQueryExtension, "VK_KHR_ray_query");
    need(features.accelerationStructureExtension, "VK_KHR_acceleration_structure");
    need(features.deferredHostOperationsExtension, "VK_KHR_deferred_host_operations");
    need(features.rayQuery || !features.rayQueryExtension, "rayQuery");
    need(features.accelerationStructure || !features.accelerationStructureExtension,
         "accelerationStructure");
    need(features.bufferDeviceAddress, "bufferDeviceAddress");
    need(features.scalarBlockLayout, "scalarBlockLayout");
    need(features.subgroupBallot,
         "subgroup ballots, votes and arithmetic in compute shaders");
    need(features.uniformArrayDynamicIndexing, "shaderUniformBufferArrayDynamicIndexing");
    need(features.uniformArrayNonUniformIndexing, "shaderUniformBufferArrayNonUniformIndexing");
    need(features.storageArrayDynamicIndexing, "shaderStorageBufferArrayDynamicIndexing");
    need(features.storageArrayNonUniformIndexing, "shaderStorageBufferArrayNonUniformIndexing");
    need(features.computeQueue, "a queue with compute");
    need(workGroupInvocations >= kWorkGroup, "maxComputeWorkGroupInvocations of 256");
    return lacks;
}

std::vector<std::string> DeviceDescription::missingForRaster() const {
    std::vector<std::string> lacks;
    if (!features.graphicsQueue) {
        lacks.emplace_back("a queue with compute and graphics");
    }
    if (!features.geometryShader) {
        lacks.emplace_back("geometryShader");
    }
    if (!features.depth32) {
        lacks.emplace_back("D32_SFLOAT depth");
    }
    return lacks;
}

std::vector<DeviceDescription> describeDevices(VkInstance instance) {
    uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> handles(count);
    check(vkEnumeratePhysicalDevices(instance, &count, handles.data()),
          "vkEnumeratePhysicalDevices");
    std::vector<DeviceDescription> devices;
    for (VkPhysicalDevice handle : handles) {
        devices.push_back(describe(handle));
    }
    return devices;
}

const DeviceDescription& chooseDevice(const std::vector<DeviceDescription>& devices,
                                      const std::string& wanted) {
    if (devices.empty()) {
        throw DeviceError(std::string("no Vulkan device: ") + kInstead);
    }
    if (!wanted.empty()) {
        const DeviceDescription& device = findWanted(devices, wanted);
        const std::vector<std::string> missing = device.missing();
        if (!missing.empty()) {
            throw DeviceError(device.name + " can't render: it lacks " + join(missing, ", ") +
                              "; " + kInstead + ". There are:" + inventory(devices));
        }
        return device;
    }
    const DeviceDescription* best = nullptr;
    for (const DeviceDescription& device : devices) {
        if (device.missing().empty() &&
            (best == nullptr || speedRank(device.type) > speedRank(best->type))) {
            best = &device;
        }
    }
    if (best == nullptr) {
        throw DeviceError(std::string("no device can render: ") + kInstead + ". There are:" +
                          inventory(devices));
    }
    return *best;
}

}  // namespace nightcity::gpu
