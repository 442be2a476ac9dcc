// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The devices of this machine, what each lacks, and which one is taken.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

namespace nightcity::gpu {

// Whatever a device needs to render, one by one, so that a lack can be named.
struct DeviceFeatures {
    bool accelerationStructureExtension = false;
    bool deferredHostOperationsExtension = false;
    bool rayQueryExtension = false;
    bool accelerationStructure = false;
    bool rayQuery = false;
    bool bufferDeviceAddress = false;
    bool scalarBlockLayout = false;
    bool subgroupBallot = false;  // votes and arithmetic too, in compute shaders
    bool uniformArrayDynamicIndexing = false;
    bool uniformArrayNonUniformIndexing = false;
    bool storageArrayDynamicIndexing = false;
    bool storageArrayNonUniformIndexing = false;
    bool computeQueue = false;
    // For rasterisation, which it may lack:
    bool graphicsQueue = false;    // the same family as the compute queue
    bool geometryShader = false;   // a triangle's number in fragment shaders
    bool depth32 = false;          // depth as 32-bit float
};

struct DeviceDescription {
    VkPhysicalDevice handle = VK_NULL_HANDLE;
    std::string name;
    std::string driver;
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    uint32_t apiVersion = 0;
    uint32_t workGroupInvocations = 0;
    uint32_t queueFamily = 0;      // with compute, and graphics where one family has both
    uint32_t timestampBits = 0;    // of that family; 0: no timestamps
    DeviceFeatures features;

    // What it lacks, in words; empty when it will do.
    std::vector<std::string> missing() const;
    // What it lacks for rasterisation, in words; empty when it can.
    std::vector<std::string> missingForRaster() const;
};

// In the driver's order, which is the order of indices in `--device`.
std::vector<DeviceDescription> describeDevices(VkInstance instance);

// The device with that index or whose name contains `wanted` (case ignored); for an empty
// `wanted` the fastest kind that lacks nothing. Throws DeviceError saying what is there, what
// is missing, and what can be done instead.
const DeviceDescription& chooseDevice(const std::vector<DeviceDescription>& devices,
                                      const std::string& wanted);

}  // namespace nightcity::gpu
