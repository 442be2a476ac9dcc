// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

namespace nightcity {

// Scene-linear radiance (W m^-2 sr^-1, Rec. 709) times 2^exposure, through the tone
// mapper "Khronos PBR Neutral" and the sRGB transfer function: 0 to 1 for a display.
glm::vec3 toneMap(glm::vec3 radiance, float exposure);

}  // namespace nightcity
