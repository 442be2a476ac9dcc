// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The scene on the device: arrays behind addresses, acceleration structures,
// and the light lists at one frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dispatch.h"
#include "gpu/acceleration_structure.h"
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "passes/light_lists.h"
#include "scene/flat_scene.h"
#include "settings.h"

namespace nightcity {

// Where the march finds its light lists.
struct LightStorageChoice {
    LightStorage storage = LightStorage::uniform;
    std::uint32_t pageEntries = 0;  // vec4 a page, a power of two
    std::uint32_t pageCount = 1;    // bound; 1 with storage, where the page is never read
    bool oneColour = false;

    bool operator==(const LightStorageChoice&) const = default;
};

class GpuScene {
public:
    GpuScene(gpu::Device& device, gpu::Commands& commands) : device_(device), commands_(commands) {}

    // Triangles, facades, materials, media boxes. Throws DeviceError where a limit is passed.
    void syncGeometry(const FlatScene& scene);
    // Which windows are on at a frame, and the lists of those that are.
    void syncWindowState(const FlatScene& scene, int frame, const RenderSettings& settings);

    VkAccelerationStructureKHR structure() const { return topLevel_.get(); }
    VkDeviceAddress tableAddress() const { return table_.address(); }
    const LightStorageChoice& lightStorage() const { return choice_; }
    const gpu::Buffer& lightEntries() const { return lightEntries_; }
    std::uint64_t pageBytes() const { return std::uint64_t{choice_.pageEntries} * 16; }
    std::vector<std::string> notes() const { return notes_; }

private:
    template <typename T>
    uvec2 uploadArray(const char* name, std::span<const T> data);
    void uploadGeometry(const FlatScene& scene);
    void buildTriangles(const FlatScene& scene);
    void buildMedia(const FlatScene& scene);
    void buildLoosePanes(const FlatScene& scene);
    void buildTopLevel();
    void chooseStorage(const PackedLights& lights, LightStorage wanted);
    void writeTable();

    gpu::Device& device_;
    gpu::Commands& commands_;
    std::vector<gpu::Buffer> arrays_;        // of the geometry
    std::vector<std::uint32_t> looseWindows_;
    gpu::AccelerationStructure triangles_;
    gpu::AccelerationStructure media_;
    gpu::AccelerationStructure loosePanes_;
    gpu::AccelerationStructure topLevel_;
    gpu::Buffer windowOn_;
    gpu::Buffer marchMedia_;
    gpu::Buffer lightEntries_;               // whole pages
    gpu::Buffer table_;
    SceneTable contents_{};
    LightStorageChoice choice_;
    std::vector<std::string> notes_;
};

// The two words of an address as the shaders take them.
uvec2 addressWords(VkDeviceAddress address);

}  // namespace nightcity
