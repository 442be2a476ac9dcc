// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// `--method reference`: the judge of every other method. No Vulkan.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "frame.h"
#include "scene/flat_scene.h"
#include "settings.h"

namespace nightcity {

struct ReferenceImage {
    Frame frame;
    RenderStatistics statistics;
    // The largest of all rays (RayResult); 0 for a march.
    double error = 0;
    double leftOut = 0;
};

// The exact integral where settings.tolerance is set, else the march of
// settings.subdivisions. On all cores; the same bytes whatever their number. `progress` (share done, 0 to 1)
// is called on this thread; what it throws ends the work.
ReferenceImage renderReference(const FlatScene& scene, const RenderProduct& product,
                               const RenderSettings& settings,
                               const std::function<void(double)>& progress);

// `count` distinct pixels of the product's frame whose centre sees a medium before
// any surface, at random by `seed`, row by row; all of them where there are fewer.
std::vector<glm::uvec2> selectPixels(const FlatScene& scene, const RenderProduct& product,
                                     std::size_t count, std::uint64_t seed);

}  // namespace nightcity
