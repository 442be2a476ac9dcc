// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The media boxes of a scene in as few boxes as it takes, for whoever integrates along
// straight ways and not box by box. No Vulkan.
#pragma once

#include <vector>

#include "far_field.h"
#include "scene/flat_scene.h"

namespace nightcity {

// Boxes of the same haze that share a whole face are one. In a scene of one haze, buildings
// that are exactly boxes count as filled with it, for nobody looks inside: the 65 boxes of the
// paper's 4 x 4 city are one. Clear boxes (extinction 0) are left out.
std::vector<FarMedium> mergeMedia(const FlatScene& scene);

}  // namespace nightcity
