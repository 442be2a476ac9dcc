// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Exact single scattering along one ray (design section 4): every window, to a
// stated error.
#pragma once

#include <span>
#include <vector>

#include "reference/airlight.h"
#include "reference/light_scene.h"
#include "reference/media_segments.h"
#include "reference/window_sum.h"

namespace nightcity {

class GroupSights;
class Hiders;

class SingleScattering {
public:
    // `lights` must outlive it.
    SingleScattering(const LightScene& lights, const Accuracy& accuracy);

    // Radiance, W m^-2 sr^-1. `segments` as MediaSegments::along returns them.
    WindowSum along(const Ray& ray, std::span<const Segment> segments) const;

private:
    std::vector<HazeStretch> stretchesOf(std::span<const Segment> segments) const;
    // The stretches that each window lights; a view into `stretches` or `storage`.
    std::vector<std::span<const HazeStretch>> litStretches(
        std::span<const Segment> segments, std::span<const HazeStretch> stretches,
        std::vector<std::vector<HazeStretch>>& storage) const;
    // Radiance per watt of one of the lit windows; `sights`: null without visibility.
    Estimate fromWindow(const Ray& ray, std::span<const HazeStretch> stretches,
                        std::uint32_t index, GroupSights* sights,
                        const Tolerance& tolerance) const;
    Estimate fromPane(const Ray& ray, std::span<const HazeStretch> stretches,
                      const LitWindow& window, const Hiders* hiders, const RayPart& part,
                      const Tolerance& tolerance) const;
    Estimate fromPoint(const Ray& ray, std::span<const HazeStretch> stretches,
                       const PointSource& source, const Hiders* hiders, const RayPart& part,
                       const Tolerance& tolerance) const;

    const LightScene& lights_;
    Accuracy accuracy_;
};

}  // namespace nightcity
