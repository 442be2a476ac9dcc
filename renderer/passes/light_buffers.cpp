// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/light_buffers.h"

#include <algorithm>
#include <bit>

#include "dispatch.h"

namespace nightcity {
namespace {

constexpr std::uint64_t kEntryBytes = sizeof(glm::vec4);
constexpr std::uint32_t kLargestUniformPage = 65536;   // bytes; devices give 16 to 64 KiB
constexpr std::uint32_t kLargestStoragePage = 1u << 26;  // bytes; devices give 128 MiB and more

std::uint32_t entriesOfPage(std::uint32_t largest, std::uint32_t limit) {
    return std::bit_floor(std::min(largest, limit)) / static_cast<std::uint32_t>(kEntryBytes);
}

std::uint64_t pagesFor(std::uint64_t entries, std::uint32_t entriesEach) {
    return std::max<std::uint64_t>(1, (entries + entriesEach - 1) / entriesEach);
}

}  // namespace

LightPages chooseLightPages(const gpu::DeviceLimits& limits, const std::string& device,
                            std::uint64_t entries, LightStorage wanted, std::string& note) {
    note.clear();
    if (wanted == LightStorage::uniform) {
        const std::uint32_t each = entriesOfPage(kLargestUniformPage, limits.uniformBufferRange);
        const std::uint64_t pages = pagesFor(entries, each);
        const std::uint64_t most =
            std::min({limits.uniformBuffersPerStage, limits.uniformBuffersPerSet,
                      limits.resourcesPerStage - 1});
        if (pages <= most) {
            return {LightStorage::uniform, each, static_cast<std::uint32_t>(pages)};
        }
        note = "the light lists fill " + std::to_string(pages) + " uniform buffers, but " +
               device + " binds at most " + std::to_string(most) +
               ": they are read from storage buffers instead";
    }
    const std::uint32_t each = entriesOfPage(kLargestStoragePage, limits.storageBufferRange);
    return {LightStorage::storage, each, static_cast<std::uint32_t>(pagesFor(entries, each))};
}

void LightBuffers::upload(const PackedLights& lights, LightStorage wanted) {
    pages_ = chooseLightPages(device_.limits(), device_.name(), lights.capacity, wanted, note_);
    const auto fill = [this](gpu::Buffer& buffer, const char* name, const void* data,
                             std::uint64_t bytes, std::uint64_t room) {
        if (!buffer || buffer.bytes() < room) {
            buffer = {};
            buffer = gpu::Buffer(device_, name, room, gpu::MemoryKind::device,
                                 VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
        }
        commands_.upload(buffer, data, bytes);
    };
    // Whole uniform pages, for each is bound in full.
    const std::uint64_t uniformPage =
        entriesOfPage(kLargestUniformPage, device_.limits().uniformBufferRange);
    const std::uint64_t room =
        pagesFor(lights.capacity, static_cast<std::uint32_t>(uniformPage)) * uniformPage;
    fill(entries_, "light lists", lights.entries.data(), lights.entries.size() * kEntryBytes,
         room * kEntryBytes);
    const std::uint64_t mediaBytes = lights.media.size() * sizeof(MarchMedium);
    fill(media_, "march media", lights.media.data(), mediaBytes, mediaBytes);
}

void LightBuffers::bind(gpu::ComputePipeline& march) const {
    const bool uniform = pages_.storage == LightStorage::uniform;
    const std::uint64_t bytesEach = pages_.entriesEach * kEntryBytes;
    const std::uint64_t uniformBytes =
        uniform ? bytesEach : kUnusedPageEntries * kEntryBytes;
    march.bindBuffers({NIGHTCITY_BINDING_UNIFORM_PAGES, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                       uniform ? pages_.count : 1},
                      entries_, uniformBytes);
    march.bindBuffers({NIGHTCITY_BINDING_STORAGE_PAGES, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                       uniform ? 1 : pages_.count},
                      entries_, uniform ? kUnusedPageEntries * kEntryBytes : bytesEach);
}

}  // namespace nightcity
