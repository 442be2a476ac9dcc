// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/flat_scene.h"

namespace nightcity {

// Linear colour of a material's texture, bilinear, repeating; 1 without a texture.
// uv (0, 0) is the bottom left texel corner (docs/scene_format.md).
glm::dvec3 textureColour(const FlatScene& scene, const Material& material, glm::dvec2 uv);

}  // namespace nightcity
