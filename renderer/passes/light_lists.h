// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The light lists of the media boxes as the march reads them (dispatch.h): only
// windows that are on, cut at the cap, in runs of equal emission, positions
// relative to the box. No Vulkan.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "dispatch.h"
#include "scene/flat_scene.h"

namespace nightcity {

struct PackedLights {
    std::vector<glm::vec4> entries;  // runs and lights
    std::vector<MarchMedium> media;  // one a media box of the scene
    // Entries that any state of the windows can need: what buffers and pages are sized by, so
    // that they and the pipelines stay as they are while windows go on and off.
    std::uint64_t capacity = 0;
};

// `windowOn`: one byte a window. `cap`: at most so many lit windows a box, by ascending index.
// Throws SceneError where the lists do not fit 32-bit indices.
PackedLights packLights(const FlatScene& scene, std::span<const std::uint8_t> windowOn,
                        std::optional<std::uint32_t> cap);

}  // namespace nightcity
