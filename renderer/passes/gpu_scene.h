// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The scene on the device: arrays behind addresses, acceleration structures,
// and the light lists at one frame.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dispatch.h"
#include "gpu/acceleration_structure.h"
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "passes/far_field_grid.h"
#include "passes/light_buffers.h"
#include "passes/near_panes.h"
#include "passes/triangle_chunks.h"
#include "scene/facades.h"
#include "scene/flat_scene.h"
#include "settings.h"

namespace nightcity {

class GpuScene {
public:
    GpuScene(gpu::Device& device, gpu::Commands& commands)
        : device_(device),
          commands_(commands),
          lights_(device, commands),
          farField_(device, commands) {}

    // Triangles, facades, materials, media boxes. Throws DeviceError where a limit is passed.
    void syncGeometry(const FlatScene& scene);
    // Which windows are on at a frame, and the lists of those that are.
    void syncWindowState(const FlatScene& scene, int frame, const RenderSettings& settings);

    // The far field of the windows that are on, one byte a window, and where the near parts of all
    // windows lie: laid out anew where geometry or settings changed, else only updated. To be
    // called after syncWindowState.
    void syncFarField(const FlatScene& scene, std::span<const std::uint8_t> windowOn,
                      const FarFieldSettings& settings, const BakeProgress& progress = {});

    VkAccelerationStructureKHR structure() const { return topLevel_.get(); }
    VkDeviceAddress tableAddress() const { return table_.address(); }
    const LightBuffers& lights() const { return lights_; }
    // What is drawn: vertices of 3 floats, 3 uint32 a triangle, and the chunks to cull by.
    VkBuffer positions() const { return positions_.get(); }
    VkBuffer triangleIndices() const { return triangleIndices_.get(); }
    std::uint64_t vertexCount() const { return positions_.bytes() / sizeof(vec3); }
    const std::vector<TriangleChunk>& chunks() const { return chunks_; }
    const FarFieldGrid& farField() const { return farField_; }
    bool isHazeUniform() const { return uniformHaze_; }  // scene/uniform_haze.h
    // Of --method field, once syncFarField was called.
    NearKinds nearKinds(double tolerance) const { return near_.kinds(tolerance); }

private:
    template <typename T>
    gpu::Buffer upload(const char* name, std::span<const T> data, VkBufferUsageFlags usage);
    template <typename T>
    uvec2 uploadArray(const char* name, std::span<const T> data);
    void uploadGeometry(const FlatScene& scene);
    void uploadOccluders(const FlatScene& scene);
    void uploadMediaTree(const FlatScene& scene);
    void uploadHaze(const FlatScene& scene);
    void uploadMediaPlanes(const FlatScene& scene);
    void uploadPlanes(const FlatScene& scene, const FacadeTable& facades);
    void uploadNearField(const FlatScene& scene, const FarFieldSettings& settings);
    void buildTriangles(const FlatScene& scene);
    void buildMedia(const FlatScene& scene);
    void buildLoosePanes(const FlatScene& scene);
    void buildTopLevel();
    void uploadState(gpu::Buffer& buffer, const char* name, const void* data, std::uint64_t bytes);
    void uploadLightTree(const FlatScene& scene, std::span<const std::uint8_t> windowOn,
                         Emitter emitter);
    void writeTable();

    gpu::Device& device_;
    gpu::Commands& commands_;
    std::vector<gpu::Buffer> arrays_;        // of the geometry
    gpu::Buffer positions_;
    gpu::Buffer triangleIndices_;
    std::vector<TriangleChunk> chunks_;
    std::vector<std::uint32_t> looseWindows_;
    gpu::AccelerationStructure triangles_;
    gpu::AccelerationStructure media_;
    gpu::AccelerationStructure loosePanes_;
    gpu::AccelerationStructure topLevel_;
    gpu::Buffer windowOn_;
    gpu::Buffer lightNodes_;
    gpu::Buffer lightTrails_;
    LightBuffers lights_;
    FarFieldGrid farField_;
    std::vector<gpu::Buffer> nearField_;
    gpu::Buffer mediaPlanes_;
    std::optional<FarFieldSettings> farFieldSettings_;  // that the far field was laid out for
    gpu::Buffer table_;
    SceneTable contents_{};
    bool uniformHaze_ = false;
    NearExtremes near_;
};

// The two words of an address as the shaders take them.
uvec2 addressWords(VkDeviceAddress address);

}  // namespace nightcity
