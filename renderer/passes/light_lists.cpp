// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/light_lists.h"

#include <algorithm>
#include <limits>
#include <string>

#include "errors.h"

namespace nightcity {
namespace {

std::span<const std::uint32_t> listOf(const FlatScene& scene, const MediaBox& box) {
    return scene.lightList.subspan(box.firstLight, box.lightCount);
}

// Sets colour where all listed windows share one.
void findColour(const FlatScene& scene, PackedLights& lights) {
    lights.oneColour = true;
    bool found = false;
    for (const MediaBox& box : scene.mediaBoxes) {
        for (std::uint32_t window : listOf(scene, box)) {
            const glm::vec3 colour = scene.windows[window].colour;
            if (!found) {
                lights.colour = colour;
                found = true;
            } else if (colour != lights.colour) {
                lights.oneColour = false;
                return;
            }
        }
    }
}

std::uint64_t countCapacity(const FlatScene& scene, std::optional<std::uint32_t> cap,
                            std::uint32_t entrySize) {
    std::uint64_t lights = 0;
    for (const MediaBox& box : scene.mediaBoxes) {
        lights += std::min(box.lightCount, cap.value_or(box.lightCount));
    }
    const std::uint64_t entries = lights * entrySize;
    if (entries > std::numeric_limits<std::uint32_t>::max()) {
        throw SceneError("light_list: the media boxes list " + std::to_string(lights) +
                         " windows in all, more than the march can index: set --light-cap, or "
                         "render a smaller part of the scene");
    }
    return entries;
}

void packEntry(const Window& window, const MediaBox& box, PackedLights& lights) {
    const glm::vec3 fromCorner(glm::dvec3(window.centre) - glm::dvec3(box.lo));
    if (lights.oneColour) {
        lights.entries.emplace_back(fromCorner, window.power);
    } else {
        lights.entries.emplace_back(fromCorner, 0.0f);
        lights.entries.emplace_back(window.power * window.colour, 0.0f);
    }
}

}  // namespace

PackedLights packLights(const FlatScene& scene, std::span<const std::uint8_t> windowOn,
                        std::optional<std::uint32_t> cap) {
    PackedLights lights;
    findColour(scene, lights);
    const std::uint32_t entrySize = lights.oneColour ? 1 : 2;
    lights.capacity = countCapacity(scene, cap, entrySize);
    lights.entries.reserve(lights.capacity);
    lights.media.reserve(scene.mediaBoxes.size());
    for (const MediaBox& box : scene.mediaBoxes) {
        const auto first = static_cast<std::uint32_t>(lights.entries.size() / entrySize);
        std::uint32_t count = 0;
        for (std::uint32_t window : listOf(scene, box)) {
            if (windowOn[window] != 0 && count < cap.value_or(box.lightCount)) {
                packEntry(scene.windows[window], box, lights);
                ++count;
            }
        }
        lights.media.push_back({box.extinction, box.extinction * box.albedo, first, count});
    }
    return lights;
}

}  // namespace nightcity
