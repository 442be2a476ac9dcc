// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which lights of the tree over the windows any brick of a layout looks into, as far_sight.comp
// decides it: what is below the others need not be known. No Vulkan.
#pragma once

#include <array>
#include <vector>

#include "far_bake.h"
#include "passes/far_layout.h"
#include "scene/box_tree.h"
#include "settings.h"

namespace nightcity {

// How a bake joins windows that are far away; as FarFieldSettings has them.
struct FarJoining {
    Emitter emitter = Emitter::pane;
    float nearRadius = 4;  // m
    float spread = 0.06f;
};

class FarCut {
public:
    FarCut(const FarLayout& layout, const FarJoining& joining);

    // Whether some brick may ask for the children of an inner node. Never false where one does.
    bool mayOpen(const FarLight& light) const;

private:
    double splitRadius(unsigned scale) const;
    double closedFrom(double reach, unsigned scale) const;

    FarJoining joining_;
    double cellSide_;
    std::vector<BoxTree> bricks_;  // of each scale
};

}  // namespace nightcity
