// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The tree over all windows that the bake of the far field walks (far_bake.h), as deep as the
// bricks look into it. Its shape does not depend on which windows are on. No Vulkan.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "far_bake.h"
#include "passes/far_cut.h"
#include "scene/flat_scene.h"
#include "settings.h"

namespace nightcity {

// Several windows in which the tree ends.
struct FarBundle {
    uint light;
    uint firstWindow;  // into FarLights.bundled
    uint windowCount;
};

struct FarLights {
    std::vector<FarLight> lights;  // the root first; empty without windows of any power
    std::vector<FarBundle> bundles;  // ascending by light
    std::vector<uint> bundled;       // windows
    std::vector<uint> roots;       // together they hold every window
    float strongest = 0;           // W, of one channel of one window
};

FarLights buildFarLights(const FlatScene& scene, std::span<const FarMedium> media,
                         const FarCut& cut, Emitter emitter);

// About how many lights such a tree has, and seldom fewer. Large bricks hold many windows.
std::uint64_t plannedFarLights(const FarLayout& layout, std::uint64_t windows);

// W per channel and light: of the windows that are on. `windowOn`: one byte a window.
std::vector<vec3> emissionOf(const FarLights& tree, const FlatScene& scene,
                             std::span<const std::uint8_t> windowOn);

// Bit i: whether anything that light i holds emits differently.
std::vector<uint> changedLights(const FarLights& tree, std::span<const vec3> before,
                                std::span<const vec3> after);

}  // namespace nightcity
