// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The logical device with its queue, limits, memory count and extension calls.
#pragma once

#include <cstdint>
#include <string>

#include <vulkan/vulkan.h>

#include "gpu/memory_ledger.h"
#include "gpu/physical_device.h"

namespace nightcity::gpu {

struct DeviceLimits {
    uint32_t uniformBufferRange = 0;       // bytes of one uniform buffer
    uint32_t storageBufferRange = 0;       // bytes of one storage buffer
    uint32_t uniformBuffersPerStage = 0;   // descriptors
    uint32_t uniformBuffersPerSet = 0;
    uint32_t resourcesPerStage = 0;
    uint32_t workGroupCount = 0;           // along x
    uint64_t allocationBytes = 0;          // of one allocation
    uint64_t accelerationPrimitives = 0;   // of one bottom-level structure
    uint32_t scratchAlignment = 1;         // bytes
    uint32_t rasterSide = 0;               // pixels, of frames that can be rasterised
    double nanosecondsPerTick = 0;         // 0: no timestamps
};

// Calls of VK_KHR_acceleration_structure, which the loader does not export.
struct AccelerationCalls {
    PFN_vkCreateAccelerationStructureKHR create = nullptr;
    PFN_vkDestroyAccelerationStructureKHR destroy = nullptr;
    PFN_vkGetAccelerationStructureBuildSizesKHR buildSizes = nullptr;
    PFN_vkCmdBuildAccelerationStructuresKHR cmdBuild = nullptr;
    PFN_vkGetAccelerationStructureDeviceAddressKHR deviceAddress = nullptr;
};

class Device {
public:
    // The description must lack nothing. Throws DeviceError.
    Device(VkInstance instance, const DeviceDescription& description);
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    ~Device();

    VkDevice get() const { return device_; }
    VkQueue queue() const { return queue_; }
    uint32_t queueFamily() const { return description_.queueFamily; }
    const std::string& name() const { return description_.name; }
    const DeviceLimits& limits() const { return limits_; }
    const AccelerationCalls& acceleration() const { return acceleration_; }
    const VkPhysicalDeviceMemoryProperties& memory() const { return memory_; }
    // True where the host can write all of the device's own memory (CPU and integrated devices).
    bool unifiedMemory() const { return unifiedMemory_; }

    // What it lacks for RasterPipeline, in words; empty when it can.
    std::vector<std::string> missingForRaster() const { return description_.missingForRaster(); }

    // Shows up in validation messages and debuggers.
    void setName(VkObjectType type, uint64_t object, const std::string& name) const;

    const MemoryLedger& ledger() const { return ledger_; }
    MemoryLedger& ledger() { return ledger_; }
    // Throws DeviceError where the ledger has no room for so many bytes more.
    void requireRoom(const std::string& name, uint64_t bytes) const;

private:
    void createDevice();
    void loadCalls(VkInstance instance);
    void queryLimits();

    DeviceDescription description_;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    DeviceLimits limits_;
    AccelerationCalls acceleration_;
    VkPhysicalDeviceMemoryProperties memory_{};
    PFN_vkSetDebugUtilsObjectNameEXT setObjectName_ = nullptr;
    bool unifiedMemory_ = false;
    MemoryLedger ledger_;
};

}  // namespace nightcity::gpu
