// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What the tests of the device share: one delegate with validation on, a frame
// in one call, and the project's measure of error.
#pragma once

#include <string>
#include <vector>

#include "render_delegate.h"
#include "scene_builder.h"

namespace nightcity {

// Of the whole test program: a device takes long to open. A validation message fails the call
// that caused it.
RenderDelegate& testDelegate();

// Syncs everything and renders. `statistics` may be null.
Frame renderOnDevice(const FlatScene& scene, const RenderProduct& product,
                     const RenderSettings& settings, RenderStatistics* statistics = nullptr);

RenderProduct productOf(const std::string& camera, std::uint32_t width, std::uint32_t height);

struct GlowErrors {
    double median = 0;
    double p95 = 0;
    double worst = 0;
    double bias = 0;  // of the mean
};

// Relative errors of glow as design section 5 has them: over max(reference, 1 % of the median
// nonzero glow), the worst of the three channels of a pixel.
GlowErrors glowErrors(const Frame& frame, const Frame& reference);

}  // namespace nightcity
