// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The packed light lists on the device, in pages of uniform or storage buffers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/compute_pipeline.h"
#include "passes/light_lists.h"
#include "settings.h"

namespace nightcity {

// Where the march finds its light lists; pipelines are specialised to it.
struct LightPages {
    LightStorage storage = LightStorage::uniform;
    std::uint32_t entriesEach = 0;  // a power of two
    std::uint32_t count = 1;

    bool operator==(const LightPages&) const = default;
};

// Pages for `entries` in the storage that is wanted, or in storage buffers where the uniform
// buffers that they need are more than the device binds: `note` then says so.
LightPages chooseLightPages(const gpu::DeviceLimits& limits, const std::string& device,
                            std::uint64_t entries, LightStorage wanted, std::string& note);

class LightBuffers {
public:
    LightBuffers(gpu::Device& device, gpu::Commands& commands)
        : device_(device), commands_(commands) {}

    void upload(const PackedLights& lights, LightStorage wanted);

    const LightPages& pages() const { return pages_; }
    VkDeviceAddress mediaAddress() const { return media_.address(); }
    const std::string& note() const { return note_; }  // empty where all is as wanted
    // Binds every page, and one page of the kind that is not used.
    void bind(gpu::ComputePipeline& march) const;

private:
    gpu::Device& device_;
    gpu::Commands& commands_;
    LightPages pages_;
    gpu::Buffer entries_;
    gpu::Buffer media_;  // MarchMedium
    std::string note_;
};

}  // namespace nightcity
