// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which windows' near parts a ray may meet in each cell of a lattice over the far field
// (shaders/shared/glow.h). Does not depend on which windows are on. No Vulkan.
#pragma once

#include <cstdint>
#include <vector>

#include "far_field.h"
#include "glow.h"
#include "scene/flat_scene.h"

namespace nightcity {

struct NearPanes {
    NearTable table{};            // the lattice; no addresses
    std::vector<NearPane> panes;  // one a window
    std::vector<uint> cellStart;  // as the table has them
    std::vector<uint> cellPanes;
};

// `field`: origin, cellSide, cellCounts and nearRadius are read.
NearPanes buildNearPanes(const FlatScene& scene, const FarFieldTable& field);

}  // namespace nightcity
