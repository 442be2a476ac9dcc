// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Exact single scattering along one ray (design section 4): every window, to a
// stated error.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reference/emitters.h"
#include "reference/haze.h"
#include "reference/media_segments.h"
#include "reference/occluders.h"
#include "settings.h"

namespace nightcity {

// What a value may be off by, as a fraction of it.
struct Accuracy {
    double relative = 1e-4;
    double leftOut = 1e-6;  // windows that together bring less than this are skipped
};

// Radiance, W m^-2 sr^-1. Errors are those of the mean of the channels.
struct ScatteredLight {
    glm::dvec3 radiance{0};
    double error = 0;     // estimated bound of the quadrature, absolute
    double leftOut = 0;   // bound of what the skipped windows bring, absolute
    std::uint64_t windows = 0;  // integrated
};

class SingleScattering {
public:
    // The scene must outlive it. Of `settings` it reads the model and the light cap.
    SingleScattering(const FlatScene& scene, int frame, const RenderSettings& settings,
                     const Accuracy& accuracy);

    // `segments` as MediaSegments::along returns them for this ray.
    ScatteredLight along(const Ray& ray, std::span<const Segment> segments) const;

    const Occluders& occluders() const { return occluders_; }
    const Haze& haze() const { return haze_; }
    const std::vector<LitWindow>& windows() const { return windows_; }

private:
    // One window and the part of the ray that it lights.
    struct Task {
        const LitWindow* window;
        std::span<const HazeStretch> stretches;
        double bound;  // W m^-2 sr^-1, mean of the channels; not below what it brings
    };

    std::vector<HazeStretch> stretchesOf(std::span<const Segment> segments) const;
    std::vector<Task> tasks(const Ray& ray, std::span<const Segment> segments,
                            std::span<const HazeStretch> stretches,
                            std::vector<std::vector<HazeStretch>>& listed) const;
    double bound(const Ray& ray, std::span<const HazeStretch> stretches,
                 const LitWindow& window) const;
    // Radiance per watt.
    Estimate fromWindow(const Ray& ray, std::span<const HazeStretch> stretches,
                        const LitWindow& window, const Tolerance& tolerance) const;
    Estimate fromPane(const Ray& ray, std::span<const HazeStretch> stretches,
                      const LitWindow& window, const Tolerance& tolerance) const;
    Estimate fromPoint(const Ray& ray, std::span<const HazeStretch> stretches,
                       const PointSource& source, const class Sight* sight,
                       const Tolerance& tolerance) const;

    const FlatScene& scene_;
    Model model_;
    Accuracy accuracy_;
    Occluders occluders_;
    Haze haze_;
    std::vector<LitWindow> windows_;
    std::vector<std::vector<std::uint32_t>> listed_;  // of each media box, into windows_
};

}  // namespace nightcity
