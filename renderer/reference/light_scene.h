// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What the exact integrals ask of a scene, at one frame and under one model.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reference/emitters.h"
#include "reference/haze.h"
#include "reference/occluders.h"
#include "reference/window_groups.h"
#include "settings.h"

namespace nightcity {

struct LightScene {
    // The scene must outlive it. Of `settings` it reads the model, reach,
    // light cap, and whether there is haze at all.
    LightScene(const FlatScene& scene, int frame, const RenderSettings& settings);

    Model model;
    double reach;                            // m, from a window's centre; infinite: no limit
    std::span<const MediaBox> mediaBoxes;
    Occluders occluders;
    Haze haze;                               // empty with media off
    bool media;
    std::vector<LitWindow> windows;
    WindowGroups groups;                     // of `windows`
    std::vector<std::vector<std::uint32_t>> listed;  // of each media box, into windows; else empty
};

}  // namespace nightcity
