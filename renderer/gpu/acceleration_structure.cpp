// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/acceleration_structure.h"

#include <bit>
#include <utility>
#include <vector>

#include "errors.h"
#include "gpu/result.h"

namespace nightcity::gpu {
namespace {

VkAccelerationStructureGeometryKHR emptyGeometry(VkGeometryTypeKHR type) {
    VkAccelerationStructureGeometryKHR geometry{};
    geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
    geometry.geometryType = type;
    return geometry;
}

VkAccelerationStructureGeometryKHR geometryOf(const TriangleGeometry& triangles) {
    VkAccelerationStructureGeometryKHR geometry = emptyGeometry(VK_GEOMETRY_TYPE_TRIANGLES_KHR);
    geometry.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
    auto& data = geometry.geometry.triangles;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
    data.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    data.vertexData.deviceAddress = triangles.positions;
    data.vertexStride = 12;
    data.maxVertex = triangles.vertexCount - 1;
    data.indexType = VK_INDEX_TYPE_UINT32;
    data.indexData.deviceAddress = triangles.indices;
    return geometry;
}

VkAccelerationStructureGeometryKHR geometryOf(const BoxGeometry& boxes) {
    VkAccelerationStructureGeometryKHR geometry = emptyGeometry(VK_GEOMETRY_TYPE_AABBS_KHR);
    // A box may be offered once only: media are counted, not just found.
    geometry.flags = VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR;
    auto& data = geometry.geometry.aabbs;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA_KHR;
    data.data.deviceAddress = boxes.boxes;
    data.stride = sizeof(VkAabbPositionsKHR);
    return geometry;
}

// `geometry` must outlive what is returned.
VkAccelerationStructureBuildGeometryInfoKHR buildInfo(
    VkAccelerationStructureTypeKHR type, const VkAccelerationStructureGeometryKHR& geometry) {
    VkAccelerationStructureBuildGeometryInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
    info.type = type;
    info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
    info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    info.geometryCount = 1;
    info.pGeometries = &geometry;
    return info;
}

VkAccelerationStructureBuildSizesInfoKHR sizesOf(
    const Device& device, const VkAccelerationStructureBuildGeometryInfoKHR& info,
    uint32_t primitives) {
    VkAccelerationStructureBuildSizesInfoKHR sizes{};
    sizes.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR;
    device.acceleration().buildSizes(device.get(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR,
                                     &info, &primitives, &sizes);
    return sizes;
}

StructureBytes structureBytes(const Device& device,
                              const VkAccelerationStructureGeometryKHR& geometry,
                              uint32_t primitives) {
    if (primitives == 0) {
        return {};
    }
    const VkAccelerationStructureBuildSizesInfoKHR sizes = sizesOf(
        device, buildInfo(VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, geometry), primitives);
    return {sizes.accelerationStructureSize, sizes.buildScratchSize};
}

VkAccelerationStructureInstanceKHR instanceRecord(const StructureInstance& instance) {
    VkAccelerationStructureInstanceKHR record{};
    record.transform.matrix[0][0] = 1;
    record.transform.matrix[1][1] = 1;
    record.transform.matrix[2][2] = 1;
    record.instanceCustomIndex = instance.customIndex & 0xffffffu;
    record.mask = instance.mask;
    record.flags = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR;
    record.accelerationStructureReference = instance.structure->address();
    return record;
}

void requirePrimitives(const Device& device, const std::string& name, uint64_t count) {
    if (count > device.limits().accelerationPrimitives) {
        throw DeviceError("the acceleration structure '" + name + "' has " +
                          std::to_string(count) + " primitives, but " + device.name() +
                          " takes at most " +
                          std::to_string(device.limits().accelerationPrimitives) +
                          ": render a smaller part of the scene, or take another --device");
    }
}

}  // namespace

StructureBytes triangleStructureBytes(const Device& device, uint32_t vertices,
                                      uint32_t triangles) {
    TriangleGeometry geometry;
    geometry.vertexCount = vertices;
    geometry.triangleCount = triangles;
    return structureBytes(device, geometryOf(geometry), triangles);
}

StructureBytes boxStructureBytes(const Device& device, uint32_t boxes) {
    return structureBytes(device, geometryOf(BoxGeometry{0, boxes}), boxes);
}

AccelerationStructure::AccelerationStructure(Device& device, Commands& commands,
                                             const std::string& name,
                                             const TriangleGeometry& triangles)
    : device_(&device) {
    requirePrimitives(device, name, triangles.triangleCount);
    const VkAccelerationStructureGeometryKHR geometry = geometryOf(triangles);
    build(commands, name, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, geometry,
          triangles.triangleCount);
}

AccelerationStructure::AccelerationStructure(Device& device, Commands& commands,
                                             const std::string& name, const BoxGeometry& boxes)
    : device_(&device) {
    requirePrimitives(device, name, boxes.boxCount);
    const VkAccelerationStructureGeometryKHR geometry = geometryOf(boxes);
    build(commands, name, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, geometry,
          boxes.boxCount);
}

AccelerationStructure::AccelerationStructure(Device& device, Commands& commands,
                                             const std::string& name,
                                             std::span<const StructureInstance> instances)
    : device_(&device) {
    std::vector<VkAccelerationStructureInstanceKHR> records;
    for (const StructureInstance& instance : instances) {
        records.push_back(instanceRecord(instance));
    }
    const uint64_t bytes = records.size() * sizeof(VkAccelerationStructureInstanceKHR);
    Buffer data(device, name + " instances", bytes, MemoryKind::device,
                VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR);
    commands.upload(data, records.data(), bytes);
    VkAccelerationStructureGeometryKHR geometry = emptyGeometry(VK_GEOMETRY_TYPE_INSTANCES_KHR);
    geometry.geometry.instances.sType =
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    geometry.geometry.instances.data.deviceAddress = data.address();
    build(commands, name, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, geometry,
          static_cast<uint32_t>(records.size()));
}

void AccelerationStructure::build(Commands& commands, const std::string& name,
                                  VkAccelerationStructureTypeKHR type,
                                  const VkAccelerationStructureGeometryKHR& geometry,
                                  uint32_t primitives) {
    const AccelerationCalls& calls = device_->acceleration();
    VkAccelerationStructureBuildGeometryInfoKHR info = buildInfo(type, geometry);
    const VkAccelerationStructureBuildSizesInfoKHR sizes = sizesOf(*device_, info, primitives);

    buffer_ = Buffer(*device_, name, sizes.accelerationStructureSize, MemoryKind::device,
                     VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR);
    VkAccelerationStructureCreateInfoKHR create{};
    create.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR;
    create.buffer = buffer_.get();
    create.size = sizes.accelerationStructureSize;
    create.type = type;
    check(calls.create(device_->get(), &create, nullptr, &structure_),
          "vkCreateAccelerationStructureKHR", name);
    device_->setName(VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR,
                     std::bit_cast<uint64_t>(structure_), name);

    const uint64_t alignment = device_->limits().scratchAlignment;
    const Buffer scratch(*device_, name + " scratch", sizes.buildScratchSize + alignment,
                         MemoryKind::device);
    info.dstAccelerationStructure = structure_;
    info.scratchData.deviceAddress = (scratch.address() + alignment - 1) / alignment * alignment;
    const VkAccelerationStructureBuildRangeInfoKHR range{primitives, 0, 0, 0};
    const VkAccelerationStructureBuildRangeInfoKHR* ranges = &range;
    commands.run(name.c_str(), [&](VkCommandBuffer recording) {
        computeBarrier(recording);
        calls.cmdBuild(recording, 1, &info, &ranges);
        computeBarrier(recording);
    });
    VkAccelerationStructureDeviceAddressInfoKHR address{};
    address.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR;
    address.accelerationStructure = structure_;
    address_ = calls.deviceAddress(device_->get(), &address);
}

AccelerationStructure::AccelerationStructure(AccelerationStructure&& other) noexcept {
    *this = std::move(other);
}

AccelerationStructure& AccelerationStructure::operator=(AccelerationStructure&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(buffer_, other.buffer_);
    std::swap(structure_, other.structure_);
    std::swap(address_, other.address_);
    return *this;
}

AccelerationStructure::~AccelerationStructure() {
    if (structure_ != VK_NULL_HANDLE) {
        device_->acceleration().destroy(device_->get(), structure_, nullptr);
    }
}

}  // namespace nightcity::gpu
