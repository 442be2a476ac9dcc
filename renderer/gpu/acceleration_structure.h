// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Bottom-level structures of triangles or boxes, and the top-level structure over them.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "gpu/buffer.h"
#include "gpu/commands.h"

namespace nightcity::gpu {

struct TriangleGeometry {
    VkDeviceAddress positions = 0;  // 3 floats a vertex, tightly packed
    uint32_t vertexCount = 0;
    VkDeviceAddress indices = 0;    // 3 uint32 a triangle
    uint32_t triangleCount = 0;
};

struct BoxGeometry {
    VkDeviceAddress boxes = 0;  // VkAabbPositionsKHR, tightly packed
    uint32_t boxCount = 0;
};

// Of a bottom-level structure of so many primitives, and of what building it takes for a while.
struct StructureBytes {
    uint64_t structure = 0;
    uint64_t scratch = 0;
};
StructureBytes triangleStructureBytes(const Device& device, uint32_t vertices, uint32_t triangles);
StructureBytes boxStructureBytes(const Device& device, uint32_t boxes);

class AccelerationStructure;

struct StructureInstance {
    const AccelerationStructure* structure = nullptr;
    uint8_t mask = 0xff;
    uint32_t customIndex = 0;
};

class AccelerationStructure {
public:
    AccelerationStructure() = default;
    // Each builds at once and waits. Throws DeviceError where a limit is passed, naming it.
    AccelerationStructure(Device& device, Commands& commands, const std::string& name,
                          const TriangleGeometry& triangles);
    AccelerationStructure(Device& device, Commands& commands, const std::string& name,
                          const BoxGeometry& boxes);
    AccelerationStructure(Device& device, Commands& commands, const std::string& name,
                          std::span<const StructureInstance> instances);
    AccelerationStructure(AccelerationStructure&& other) noexcept;
    AccelerationStructure& operator=(AccelerationStructure&& other) noexcept;
    AccelerationStructure(const AccelerationStructure&) = delete;
    AccelerationStructure& operator=(const AccelerationStructure&) = delete;
    ~AccelerationStructure();

    VkAccelerationStructureKHR get() const { return structure_; }
    VkDeviceAddress address() const { return address_; }
    explicit operator bool() const { return structure_ != VK_NULL_HANDLE; }

private:
    void build(Commands& commands, const std::string& name, VkAccelerationStructureTypeKHR type,
               const VkAccelerationStructureGeometryKHR& geometry, uint32_t primitives);

    Device* device_ = nullptr;
    Buffer buffer_;
    VkAccelerationStructureKHR structure_ = VK_NULL_HANDLE;
    VkDeviceAddress address_ = 0;
};

}  // namespace nightcity::gpu
