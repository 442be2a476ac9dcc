// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/light_lists.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <map>
#include <string>

#include "errors.h"

namespace nightcity {
namespace {

// Windows that emit the same share a number; numbers follow the first window of each.
struct Emissions {
    std::vector<std::uint32_t> ofWindow;
    std::vector<glm::vec3> watts;
};

Emissions numberEmissions(const FlatScene& scene) {
    Emissions emissions;
    emissions.ofWindow.reserve(scene.windows.size());
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> numbers;
    for (const Window& window : scene.windows) {
        const glm::vec3 watts = window.power * window.colour;
        const std::array<std::uint32_t, 3> bits{std::bit_cast<std::uint32_t>(watts.x),
                                                std::bit_cast<std::uint32_t>(watts.y),
                                                std::bit_cast<std::uint32_t>(watts.z)};
        const auto next = static_cast<std::uint32_t>(emissions.watts.size());
        const auto [found, isNew] = numbers.emplace(bits, next);
        if (isNew) {
            emissions.watts.push_back(watts);
        }
        emissions.ofWindow.push_back(found->second);
    }
    return emissions;
}

class Packer {
public:
    Packer(const FlatScene& scene, std::span<const std::uint8_t> windowOn,
           std::optional<std::uint32_t> cap)
        : scene_(scene),
          windowOn_(windowOn),
          cap_(cap.value_or(std::numeric_limits<std::uint32_t>::max())),
          emissions_(numberEmissions(scene)),
          lastBoxWith_(emissions_.watts.size(), kNone) {}

    PackedLights pack() {
        for (std::uint32_t box = 0; box < scene_.mediaBoxes.size(); ++box) {
            lights_.capacity += mostEntries(box);
        }
        if (lights_.capacity > std::numeric_limits<std::uint32_t>::max()) {
            throw SceneError("light_list: the lists of all media boxes take " +
                             std::to_string(lights_.capacity) +
                             " entries, more than the march can index: set --light-cap, or "
                             "render a smaller part of the scene");
        }
        lights_.entries.reserve(lights_.capacity);
        lights_.media.reserve(scene_.mediaBoxes.size());
        for (const MediaBox& box : scene_.mediaBoxes) {
            packBox(box);
        }
        return std::move(lights_);
    }

private:
    std::span<const std::uint32_t> listOf(const MediaBox& box) const {
        return scene_.lightList.subspan(box.firstLight, box.lightCount);
    }

    // Of a box, whichever windows are on: its lights, and a run for each emission among them.
    std::uint64_t mostEntries(std::uint32_t box) {
        std::uint32_t emissions = 0;
        for (std::uint32_t window : listOf(scene_.mediaBoxes[box])) {
            std::uint32_t& last = lastBoxWith_[emissions_.ofWindow[window]];
            emissions += last != box ? 1 : 0;
            last = box;
        }
        const std::uint64_t lights = std::min(scene_.mediaBoxes[box].lightCount, cap_);
        return lights + std::min<std::uint64_t>(emissions + lights / kRunLengthMask, lights);
    }

    void packBox(const MediaBox& box) {
        listed_.clear();
        for (std::uint32_t window : listOf(box)) {
            if (windowOn_[window] != 0 && listed_.size() < cap_) {
                listed_.push_back(window);
            }
        }
        std::stable_sort(listed_.begin(), listed_.end(), [this](std::uint32_t a, std::uint32_t b) {
            return emissions_.ofWindow[a] < emissions_.ofWindow[b];
        });
        const std::size_t first = lights_.entries.size();
        for (std::size_t i = 0; i < listed_.size();) {
            i = packRun(box, i);
        }
        lights_.media.push_back({box.extinction, box.extinction * box.albedo,
                                 static_cast<std::uint32_t>(first),
                                 static_cast<std::uint32_t>(lights_.entries.size() - first),
                                 static_cast<std::uint32_t>(listed_.size())});
    }

    // The run that begins at listed_[first]. Returns where the next begins.
    std::size_t packRun(const MediaBox& box, std::size_t first) {
        const std::uint32_t emission = emissions_.ofWindow[listed_[first]];
        std::size_t end = first;
        while (end < listed_.size() && emissions_.ofWindow[listed_[end]] == emission &&
               end - first < kRunLengthMask) {
            ++end;
        }
        const auto length = static_cast<std::uint32_t>(end - first);
        lights_.entries.emplace_back(emissions_.watts[emission],
                                     std::bit_cast<float>(kRunLengthExponent | length));
        for (std::size_t i = first; i < end; ++i) {
            const glm::dvec3 centre(scene_.windows[listed_[i]].centre);
            lights_.entries.emplace_back(glm::vec3(centre - glm::dvec3(box.lo)), 0.0f);
        }
        return end;
    }

    const FlatScene& scene_;
    std::span<const std::uint8_t> windowOn_;
    std::uint32_t cap_;
    Emissions emissions_;
    std::vector<std::uint32_t> lastBoxWith_;  // of each emission
    std::vector<std::uint32_t> listed_;       // of the box at hand
    PackedLights lights_;
};

}  // namespace

PackedLights packLights(const FlatScene& scene, std::span<const std::uint8_t> windowOn,
                        std::optional<std::uint32_t> cap) {
    return Packer(scene, windowOn, cap).pack();
}

}  // namespace nightcity
