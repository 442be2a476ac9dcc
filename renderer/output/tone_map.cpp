// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "output/tone_map.h"

#include <algorithm>
#include <cmath>

namespace nightcity {

namespace {

// Khronos 2024, "PBR Neutral Tone Mapper" (github.com/KhronosGroup/ToneMapping,
// PBR_Neutral), with its constants: colours below startCompression keep their hue
// and saturation, brighter ones roll off to white.
glm::vec3 pbrNeutral(glm::vec3 colour) {
    constexpr float startCompression = 0.8f - 0.04f;
    constexpr float desaturation = 0.15f;
    const float lowest = std::min({colour.x, colour.y, colour.z});
    const float offset = lowest < 0.08f ? lowest - 6.25f * lowest * lowest : 0.04f;
    colour -= offset;
    const float peak = std::max({colour.x, colour.y, colour.z});
    if (peak < startCompression) {
        return colour;
    }
    constexpr float d = 1 - startCompression;
    const float newPeak = 1 - d * d / (peak + d - startCompression);
    colour *= newPeak / peak;
    const float grey = 1 - 1 / (desaturation * (peak - newPeak) + 1);
    return glm::mix(colour, glm::vec3(newPeak), grey);
}

// IEC 61966-2-1.
float srgbFromLinear(float value) {
    const float v = std::clamp(value, 0.0f, 1.0f);
    return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

}  // namespace

glm::vec3 toneMap(glm::vec3 radiance, float exposure) {
    // 1e6 is white by far, and keeps the products finite.
    const glm::vec3 exposed = glm::min(radiance * std::exp2(exposure), glm::vec3(1e6f));
    const glm::vec3 mapped = pbrNeutral(glm::max(exposed, glm::vec3(0)));
    return {srgbFromLinear(mapped.x), srgbFromLinear(mapped.y), srgbFromLinear(mapped.z)};
}

}  // namespace nightcity
