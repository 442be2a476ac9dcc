// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The path tracer against the judge (design section 5).
#include <chrono>
#include <cmath>
#include <iostream>
#include <ostream>

#include <gtest/gtest.h>

#include "device_frame.h"
#include "reference/reference_renderer.h"

namespace nightcity {
namespace {

// Of pixels whose judged glow is not 0; green, for channels of one window rise and fall together.
struct Agreement {
    std::size_t pixels = 0;
    double bias = 0;           // of the mean, in its standard errors
    double standardError = 0;  // of the mean, relative
    double worst = 0;          // z of a pixel
};

Agreement agreement(const Frame& frame, const Frame& judged) {
    double sum = 0, expected = 0, variance = 0;
    Agreement result;
    for (std::size_t i = 0; i < judged.glow.size(); ++i) {
        const double found = frame.glow[i].y, truth = judged.glow[i].y;
        const double error = frame.glowError[i].y;
        if (truth == 0) {
            EXPECT_EQ(found, 0);
            continue;
        }
        ++result.pixels;
        sum += found;
        expected += truth;
        variance += error * error;
        result.worst = std::max(result.worst, std::abs(found - truth) / error);
    }
    result.bias = (sum - expected) / std::sqrt(variance);
    result.standardError = std::sqrt(variance) / expected;
    return result;
}

// Sidak: |z| that the largest of n independent normal numbers passes with probability 1 %.
double largestZ(std::size_t n) {
    const double each = 1 - std::pow(0.99, 1 / double(n));
    double low = 0, high = 10;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (std::erfc(middle / std::sqrt(2)) > each ? low : high) = middle;
    }
    return high;
}

RenderSettings pathSettings(const Model& model, std::uint32_t samples) {
    RenderSettings settings;
    settings.method = Method::path;
    settings.model = model;
    settings.samples = samples;
    settings.seed = 11;
    return settings;
}

Frame judge(const FlatScene& scene, const RenderProduct& product, const Model& model) {
    RenderSettings settings;
    settings.method = Method::reference;
    settings.model = model;
    settings.tolerance = 0.001;
    return renderReference(scene, product, settings, {}).frame;
}

struct Case {
    const char* camera;
    Model model;
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.camera << (c.model.lights == Lights::all ? " all" : " listed")
         << (c.model.visibility == Visibility::full ? " full" : " none")
         << (c.model.emitter == Emitter::isotropic    ? " isotropic"
             : c.model.emitter == Emitter::lambertian ? " lambertian"
                                                      : " pane");
}

class PathAndJudge : public testing::TestWithParam<Case> {};

TEST_P(PathAndJudge, AgreeOnThePaperCity) {
    const FlatScene scene = paperCity(2).load();
    RenderProduct product = productOf(GetParam().camera, 1920, 1061);
    product.pixels = selectPixels(scene, product, 32, 3);
    RenderStatistics statistics;
    const Frame frame =
        renderOnDevice(scene, product, pathSettings(GetParam().model, 4096), &statistics);
    const auto t = std::chrono::steady_clock::now();
    const Frame judged = judge(scene, product, GetParam().model);
    const std::chrono::duration<double> w = std::chrono::steady_clock::now() - t;
    const Agreement found = agreement(frame, judged);
    std::cout << "ms " << statistics.frameMilliseconds << " judge s " << w.count() << " bias "
              << found.bias << " se " << found.standardError << " worst " << found.worst << "\n";
    EXPECT_LT(std::abs(found.bias), 3);
    EXPECT_LT(found.worst, largestZ(found.pixels));
    EXPECT_LT(found.standardError, 0.005);
}

INSTANTIATE_TEST_SUITE_P(
    Models, PathAndJudge,
    testing::Values(
        Case{"overview75", {Lights::all, Visibility::full, Emitter::pane}},
        Case{"street", {Lights::all, Visibility::full, Emitter::lambertian}},
        Case{"overview75", {Lights::all, Visibility::full, Emitter::isotropic}},
        Case{"street", {Lights::all, Visibility::none, Emitter::pane}},
        Case{"street", {Lights::all, Visibility::none, Emitter::lambertian}},
        Case{"overview75", {Lights::all, Visibility::none, Emitter::isotropic}},
        Case{"street", {Lights::listed, Visibility::full, Emitter::pane}},
        Case{"overview75", {Lights::listed, Visibility::none, Emitter::isotropic}}));

}  // namespace
}  // namespace nightcity
