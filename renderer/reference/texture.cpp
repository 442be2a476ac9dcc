// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/texture.h"

#include <cmath>

namespace nightcity {

namespace {

// IEC 61966-2-1.
double linearFromSrgb(std::uint32_t byte) {
    const double s = byte / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

std::uint32_t repeat(double place, std::uint32_t size) {
    return std::uint32_t(place - std::floor(place / size) * size) % size;
}

}  // namespace

glm::dvec3 textureColour(const FlatScene& scene, const Material& material, glm::dvec2 uv) {
    if (material.firstTexel == kNone) {
        return glm::dvec3(1);
    }
    const glm::dvec2 place = uv * glm::dvec2(material.width, material.height) - 0.5;
    const glm::dvec2 cell = glm::floor(place);
    const glm::dvec2 part = place - cell;
    glm::dvec3 colour(0);
    for (int corner = 0; corner < 4; ++corner) {
        const int right = corner & 1, above = corner >> 1;
        const std::uint32_t column = repeat(cell.x + right, material.width);
        const std::uint32_t row = repeat(cell.y + above, material.height);
        const std::uint32_t texel =
            scene.texels[material.firstTexel + std::size_t{row} * material.width + column];
        const double weight = (right ? part.x : 1 - part.x) * (above ? part.y : 1 - part.y);
        colour += weight * glm::dvec3(linearFromSrgb(texel & 255), linearFromSrgb(texel >> 8 & 255),
                                      linearFromSrgb(texel >> 16 & 255));
    }
    return colour;
}

}  // namespace nightcity
