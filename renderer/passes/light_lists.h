// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The light lists of the media boxes as the march reads them: only windows that
// are on, cut at the cap, positions relative to the box. No Vulkan.
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
    std::vector<glm::vec4> entries;   // one or two a light, see dispatch.h
    std::vector<MarchMedium> media;   // one a media box of the scene
    bool oneColour = false;           // every listed window, on or off, has `colour`
    glm::vec3 colour{1};
    // Room for the lists with every window on: what buffers are sized by, so that they and
    // the pipelines stay as they are while windows go on and off.
    std::uint64_t capacity = 0;       // entries
};

// `windowOn`: one byte a window. `cap`: at most so many lit windows a box, by ascending index.
// Throws SceneError where the lists do not fit 32-bit indices.
PackedLights packLights(const FlatScene& scene, std::span<const std::uint8_t> windowOn,
                        std::optional<std::uint32_t> cap);

}  // namespace nightcity
