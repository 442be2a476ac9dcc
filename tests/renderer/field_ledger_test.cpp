// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What --method field says of its own error and work: held to the judge.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "aovs.h"
#include "device_frame.h"
#include "reference/reference_renderer.h"

namespace nightcity {
namespace {

RenderSettings ledgerSettings(double tolerance) {
    RenderSettings settings;
    settings.method = Method::field;
    settings.model = {Lights::all, Visibility::full, Emitter::pane, Scattering::single,
                      Surfaces::dim};
    settings.tolerance = tolerance;
    return settings;
}

RenderProduct everyNth(RenderProduct product, std::uint32_t step) {
    for (std::uint32_t y = 0; y < product.height; y += step) {
        for (std::uint32_t x = 0; x < product.width; x += step) {
            product.pixels.emplace_back(x, y);
        }
    }
    return product;
}

double medianOf(std::vector<double> values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// `factor`: of the median error, at most the median estimate.
struct LedgerCase {
    const char* camera;
    double factor;
};

void PrintTo(const LedgerCase& c, std::ostream* out) { *out << c.camera; }

class FieldLedger : public testing::TestWithParam<LedgerCase> {};

// Design section 5: exceeded on at most 1 % of pixels, and its median at most 10 times the error's.
// The latter not in the street of one building: there all windows are near, and what is
// allowed for far ones is not used up.
TEST_P(FieldLedger, EstimateHoldsAgainstTheJudge) {
    const FlatScene scene = paperCity(1).load();
    const RenderProduct product = everyNth(productOf(GetParam().camera, 141, 79), 2);
    const Frame field = renderOnDevice(scene, product, ledgerSettings(0.01));
    RenderSettings exact = ledgerSettings(1e-3);
    exact.method = Method::reference;
    const Frame judge = renderReference(scene, product, exact, {}).frame;
    std::vector<double> errors, estimates;
    std::size_t exceeded = 0;
    for (std::size_t i = 0; i < judge.glow.size(); ++i) {
        if (judge.glow[i].y > 0) {
            errors.push_back(std::abs(double(field.glow[i].y) / double(judge.glow[i].y) - 1));
            estimates.push_back(double(field.error[i]));
            exceeded += errors.back() > estimates.back() ? 1 : 0;
        }
    }
    ASSERT_GT(errors.size(), 100u);
    EXPECT_LE(double(exceeded), 0.01 * double(errors.size()));
    EXPECT_LE(medianOf(estimates), GetParam().factor * medianOf(errors));
}

INSTANTIATE_TEST_SUITE_P(PaperCity, FieldLedger,
                         testing::Values(LedgerCase{"overview75", 10}, LedgerCase{"street", 15}));

TEST(FieldLedgers, AreOfWhatWasDone) {
    const FlatScene scene = paperCity(1).load();
    RenderProduct product = productOf("overview75", 480, 265);
    RenderSettings settings = ledgerSettings(0.03);
    const Frame sparse = renderOnDevice(scene, product, settings);
    settings.glowRays = GlowRays::all;
    const Frame all = renderOnDevice(scene, product, settings);
    std::size_t interpolated = 0;
    for (std::size_t i = 0; i < all.glow.size(); ++i) {
        ASSERT_EQ(all.glow[i].y > 0, all.error[i] > 0);
        // A ray onto a roof may meet a few micrometres of haze, whose samples lie in the building.
        if (all.glow[i].y > 0 || all.transmittance[i] < 1 - 1e-5f) {
            ASSERT_GT(all.cost[i], 0.0f);
        }
        if (all.glow[i].y == 0) {
            ASSERT_GT(all.transmittance[i], 1 - 1e-5f);
        }
        interpolated += sparse.cost[i] == 0 && all.cost[i] > 0 ? 1 : 0;
        ASSERT_TRUE(sparse.cost[i] == 0 || sparse.cost[i] == all.cost[i]);
    }
    EXPECT_GT(interpolated, 100u);
}

TEST(FieldLedgers, ChangeNothingElseAndAreZeroWithoutHaze) {
    const FlatScene scene = paperCity(1).load();
    RenderProduct product = productOf("overview75", 80, 44);
    RenderSettings settings = ledgerSettings(0.03);
    settings.pixelSamples = 3;
    const Frame with = renderOnDevice(scene, product, settings);
    product.aovs = kCommonAovs;
    EXPECT_EQ(renderOnDevice(scene, product, settings).glow, with.glow);
    EXPECT_GT(*std::max_element(with.error.begin(), with.error.end()), 0.0f);
    settings.media = false;
    product.aovs = kAllAovs;
    const Frame surfaces = renderOnDevice(scene, product, settings);
    EXPECT_EQ(surfaces.error, std::vector<float>(surfaces.error.size(), 0.0f));
    EXPECT_EQ(surfaces.cost, std::vector<float>(surfaces.cost.size(), 0.0f));
}

}  // namespace
}  // namespace nightcity
