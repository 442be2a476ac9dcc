// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "frame.h"

namespace nightcity {

void Frame::resize(std::uint32_t w, std::uint32_t h) {
    width = w;
    height = h;
    const std::size_t count = std::size_t{w} * h;
    beauty.assign(count, glm::vec4(0));
    glow.assign(count, glm::vec3(0));
    surface.assign(count, glm::vec3(0));
    glowError.assign(count, glm::vec3(0));
    error.assign(count, 0.0f);
    cost.assign(count, 0.0f);
    transmittance.assign(count, 1.0f);
    depth.assign(count, kSkyDepth);
    normal.assign(count, glm::vec3(0));
    mediaId.assign(count, -1.0f);
    materialId.assign(count, -1.0f);
}

}  // namespace nightcity
