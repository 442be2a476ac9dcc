// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "device_frame.h"

#include <algorithm>
#include <cmath>

namespace nightcity {
namespace {

double quantileOf(std::vector<double> values, double share) {
    if (values.empty()) {
        return 0;
    }
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

}  // namespace

RenderDelegate& testDelegate() {
    static const std::unique_ptr<RenderDelegate> delegate = [] {
        DeviceOptions options;
        options.validation = true;
        return RenderDelegate::create(options);
    }();
    return *delegate;
}

Frame renderOnDevice(const FlatScene& scene, const RenderProduct& product,
                     const RenderSettings& settings, RenderStatistics* statistics) {
    RenderDelegate& delegate = testDelegate();
    delegate.sync(scene, product.camera, product.frame, settings, {});
    delegate.render(product, settings, {});
    if (statistics != nullptr) {
        *statistics = delegate.statistics();
    }
    return delegate.resolve();
}

RenderProduct productOf(const std::string& camera, std::uint32_t width, std::uint32_t height) {
    RenderProduct product;
    product.camera = camera;
    product.width = width;
    product.height = height;
    return product;
}

GlowErrors glowErrors(const Frame& frame, const Frame& reference) {
    std::vector<double> nonzero;
    for (const glm::vec3& glow : reference.glow) {
        if (glow.y > 0) {
            nonzero.push_back(glow.y);
        }
    }
    const double floor = 0.01 * quantileOf(nonzero, 0.5);
    std::vector<double> errors;
    double sum = 0, referenceSum = 0;
    for (std::size_t i = 0; i < reference.glow.size(); ++i) {
        double error = 0;
        for (int channel = 0; channel < 3; ++channel) {
            const double expected = reference.glow[i][channel];
            const double scale = std::max(expected, floor);
            const double found = std::abs(frame.glow[i][channel] - expected);
            error = std::max(error, scale > 0 ? found / scale : found);
        }
        errors.push_back(error);
        sum += frame.glow[i].y;
        referenceSum += reference.glow[i].y;
    }
    GlowErrors result;
    result.median = quantileOf(errors, 0.5);
    result.p95 = quantileOf(errors, 0.95);
    result.worst = *std::max_element(errors.begin(), errors.end());
    result.bias = sum / referenceSum - 1;
    return result;
}

}  // namespace nightcity
