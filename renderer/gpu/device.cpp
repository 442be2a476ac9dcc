// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device.h"

#include <algorithm>
#include <iterator>

#include "errors.h"
#include "gpu/result.h"

namespace nightcity::gpu {

Device::Device(VkInstance instance, const DeviceDescription& description)
    : description_(description) {
    vkGetPhysicalDeviceMemoryProperties(description_.handle, &memory_);
    unifiedMemory_ = description_.type == VK_PHYSICAL_DEVICE_TYPE_CPU ||
                     description_.type == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU;
    queryLimits();
    createDevice();
    loadCalls(instance);
}

Device::~Device() {
    vkDestroyDevice(device_, nullptr);
}

void Device::requireRoom(const std::string& name, uint64_t bytes) const {
    if (!ledger_.hasRoomFor(bytes)) {
        const auto mebibytes = [](uint64_t size) { return std::to_string((size >> 20) + 1) + " MiB"; };
        throw DeviceError("'" + name + "' takes " + mebibytes(bytes) + " beside the " +
                          mebibytes(ledger_.bytes()) + " that are held, more than the " +
                          mebibytes(ledger_.limit()) +
                          " that --memory allows: allow more, or render a smaller --size or city");
    }
}

void Device::createDevice() {
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = description_.queueFamily;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;

    VkPhysicalDeviceRayQueryFeaturesKHR rayQuery{};
    rayQuery.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
    rayQuery.rayQuery = VK_TRUE;
    VkPhysicalDeviceAccelerationStructureFeaturesKHR acceleration{};
    acceleration.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
    acceleration.accelerationStructure = VK_TRUE;
    acceleration.pNext = &rayQuery;
    VkPhysicalDeviceVulkan12Features vulkan12{};
    vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    vulkan12.bufferDeviceAddress = VK_TRUE;
    vulkan12.scalarBlockLayout = VK_TRUE;
    vulkan12.shaderUniformBufferArrayNonUniformIndexing = VK_TRUE;
    vulkan12.shaderStorageBufferArrayNonUniformIndexing = VK_TRUE;
    vulkan12.pNext = &acceleration;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.features.shaderUniformBufferArrayDynamicIndexing = VK_TRUE;
    features.features.shaderStorageBufferArrayDynamicIndexing = VK_TRUE;
    features.features.geometryShader = description_.features.geometryShader ? VK_TRUE : VK_FALSE;
    features.pNext = &vulkan12;

    const char* extensions[] = {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME,
                                VK_KHR_RAY_QUERY_EXTENSION_NAME};
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &features;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = static_cast<uint32_t>(std::size(extensions));
    info.ppEnabledExtensionNames = extensions;
    check(vkCreateDevice(description_.handle, &info, nullptr, &device_), "vkCreateDevice",
          description_.name);
    vkGetDeviceQueue(device_, description_.queueFamily, 0, &queue_);
}

void Device::loadCalls(VkInstance instance) {
    const auto load = [this](auto& call, const char* name) {
        call = reinterpret_cast<std::remove_reference_t<decltype(call)>>(
            vkGetDeviceProcAddr(device_, name));
    };
    load(acceleration_.create, "vkCreateAccelerationStructureKHR");
    load(acceleration_.destroy, "vkDestroyAccelerationStructureKHR");
    load(acceleration_.buildSizes, "vkGetAccelerationStructureBuildSizesKHR");
    load(acceleration_.cmdBuild, "vkCmdBuildAccelerationStructuresKHR");
    load(acceleration_.deviceAddress, "vkGetAccelerationStructureDeviceAddressKHR");
    setObjectName_ = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
        vkGetInstanceProcAddr(instance, "vkSetDebugUtilsObjectNameEXT"));
}

void Device::queryLimits() {
    VkPhysicalDeviceAccelerationStructurePropertiesKHR acceleration{};
    acceleration.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR;
    VkPhysicalDeviceMaintenance3Properties maintenance3{};
    maintenance3.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
    maintenance3.pNext = &acceleration;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &maintenance3;
    vkGetPhysicalDeviceProperties2(description_.handle, &properties);
    const VkPhysicalDeviceLimits& all = properties.properties.limits;
    limits_.uniformBufferRange = all.maxUniformBufferRange;
    limits_.storageBufferRange = all.maxStorageBufferRange;
    limits_.uniformBuffersPerStage = all.maxPerStageDescriptorUniformBuffers;
    limits_.uniformBuffersPerSet = all.maxDescriptorSetUniformBuffers;
    limits_.resourcesPerStage = all.maxPerStageResources;
    limits_.workGroupCount = all.maxComputeWorkGroupCount[0];
    limits_.allocationBytes = maintenance3.maxMemoryAllocationSize;
    limits_.accelerationPrimitives = acceleration.maxPrimitiveCount;
    limits_.scratchAlignment =
        std::max(1u, acceleration.minAccelerationStructureScratchOffsetAlignment);
    limits_.rasterSide =
        std::min({all.maxImageDimension2D, all.maxFramebufferWidth, all.maxFramebufferHeight,
                  all.maxViewportDimensions[0], all.maxViewportDimensions[1]});
    limits_.nanosecondsPerTick = description_.timestampBits > 0 ? all.timestampPeriod : 0;
}

void Device::setName(VkObjectType type, uint64_t object, const std::string& name) const {
    if (setObjectName_ == nullptr) {
        return;
    }
    VkDebugUtilsObjectNameInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
    info.objectType = type;
    info.objectHandle = object;
    info.pObjectName = name.c_str();
    check(setObjectName_(device_, &info), "vkSetDebugUtilsObjectNameEXT", name);
}

}  // namespace nightcity::gpu
