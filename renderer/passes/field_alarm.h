// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Says where the far field is too coarse for what a camera sees: a large city from afar has more
// haze than its bricks resolve, and its glow is then off by tens of per cent.
#pragma once

#include <optional>
#include <string>

#include "passes/frame_renderer.h"

namespace nightcity {

// The median over the hazy pixels of a small frame of the error that the field itself estimates
// (docs/accuracy.md), relative, and 1 where the haze is black. None where no pixel sees haze. The
// scene's field must be synced, and some of its windows lit.
std::optional<double> estimateFieldError(gpu::Device& device, gpu::Commands& commands,
                                         const GpuScene& scene, const CameraFrame& camera,
                                         const RenderProduct& product,
                                         const RenderSettings& settings);

// A sentence for the user where the estimate is far above what the tolerance lets it be; else none.
std::optional<std::string> fieldAlarm(double estimate, double tolerance, std::uint64_t bricks);

}  // namespace nightcity
