// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/field_alarm.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "aovs.h"

namespace nightcity {
namespace {

constexpr std::uint32_t kWidth = 192;  // pixels
// In tolerances: where bricks are as small as the tolerance asks, the median estimate is at most 1.
constexpr double kAlarming = 2;
constexpr float kHazy = 1 - 1e-5f;  // transmittance; below it rounding is no haze

std::string percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g %%", 100 * share);
    return text;
}

// The median over the hazy pixels of a small frame of the error that the field itself estimates
// (docs/accuracy.md), relative, and 1 where the haze is black. None where no pixel sees haze.
std::optional<double> estimateFieldError(gpu::Device& device, gpu::Commands& commands,
                                         const GpuScene& scene, const CameraFrame& camera,
                                         const RenderProduct& product,
                                         const RenderSettings& settings) {
    RenderProduct small = product;
    small.width = std::min(product.width, kWidth);
    small.height = std::max<std::uint32_t>(
        1, static_cast<std::uint32_t>(std::uint64_t{product.height} * small.width / product.width));
    small.pixels.clear();
    small.tile.reset();
    small.aovs = kAovGlow | kAovError | kAovTransmittance;
    RenderSettings single = settings;
    single.pixelSamples = 1;
    Frame frame;
    frame.resize(small.width, small.height);
    FrameRenderer(device, commands).render(scene, camera, small, single, {}, frame);
    std::vector<float> errors;
    for (std::size_t i = 0; i < frame.error.size(); ++i) {
        if (frame.transmittance[i] < kHazy) {
            errors.push_back(frame.glow[i] == glm::vec3(0) ? 1 : frame.error[i]);
        }
    }
    if (errors.empty()) {
        return std::nullopt;
    }
    const auto middle = errors.begin() + std::ptrdiff_t(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    return *middle;
}

}  // namespace

std::optional<std::string> fieldAlarm(double estimate, double tolerance, std::uint64_t bricks) {
    if (estimate <= kAlarming * tolerance) {
        return std::nullopt;
    }
    return "the " + std::to_string(bricks) +
           " bricks of the field are too coarse for what this camera sees: it estimates that half "
           "of the glow may be off by " + percent(estimate) + " or more, where --tolerance asks for " +
           percent(tolerance) + " (--aovs error shows where); more --bricks bring it down and take "
           "longer to bake, --method gauss keeps to the tolerance, however long that takes";
}

void FieldAlarm::sceneChanged() {
    estimated_.reset();
    note_.reset();
}

void FieldAlarm::update(gpu::Device& device, gpu::Commands& commands, const GpuScene& scene,
                        const FlatScene& flat, const RenderProduct& product,
                        const RenderSettings& settings) {
    const bool field = settings.method == Method::field && settings.media;
    const double tolerance = settings.tolerance.value_or(kFieldTolerance);
    const View view{product.camera, tolerance, settings.model, settings.bricks};
    if (field && estimated_ == view) {
        return;
    }
    sceneChanged();
    if (!field || !scene.farField().layout().hasLargeBricks()) {
        return;
    }
    const std::vector<std::uint8_t> on = flat.windowsOn(product.frame);
    if (std::ranges::none_of(on, [](std::uint8_t lit) { return lit != 0; })) {
        return;
    }
    estimated_ = view;
    const CameraFrame& camera = flat.camera(product.camera).at(product.frame);
    const std::optional<double> estimate =
        estimateFieldError(device, commands, scene, camera, product, settings);
    if (estimate) {
        note_ = fieldAlarm(*estimate, tolerance, scene.farField().brickCount());
    }
}

}  // namespace nightcity
