// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What polynomial_trig.h promises, over its whole ranges.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "airlight_cases.h"
#include "transport/polynomial_trig.h"

namespace nightcity {
namespace {

TEST(PolynomialTrig, AtanIsRelativelyExactDownToTheSmallestArguments) {
    double worst = 0;
    for (float x = 1.0f; x > 1e-30f; x = x > 1e-3f ? x - 1e-6f : x * 0.999f) {
        worst = std::max(worst, std::abs(atanUnit(x) / std::atan(double(x)) - 1));
    }
    EXPECT_LT(worst, 2e-7);
    EXPECT_EQ(atanUnit(0.0f), 0.0f);
}

TEST(PolynomialTrig, ArcIsRelativelyExactInTheHalfPlane) {
    RandomNumbers random(1);
    double worst = 0;
    for (int k = 0; k < 1000000; ++k) {
        const float sine = float(random.logBetween(1e-15, 1e6));
        const float cosine = float(random.between(-1, 1) * random.logBetween(1e-15, 1e6));
        const double exact = std::atan2(double(sine), double(cosine));
        worst = std::max(worst, std::abs(arcOf(sine, cosine) / exact - 1));
    }
    EXPECT_LT(worst, 2e-7);
    EXPECT_EQ(arcOf(0.0f, 1.0f), 0.0f);
    EXPECT_FLOAT_EQ(arcOf(0.0f, -1.0f), std::numbers::pi_v<float>);
    EXPECT_FLOAT_EQ(arcOf(1.0f, 0.0f), std::numbers::pi_v<float> / 2);
}

TEST(PolynomialTrig, SineAndCosineOfAQuarterTurn) {
    double sine = 0, cosine = 0;
    for (int k = 1; k <= 2000000; ++k) {
        const float a = std::min(float(k) * (kQuarterTurn / 2000000), kQuarterTurn);
        const vec2 both = quarterTurn(a);
        sine = std::max(sine, std::abs(both.x / std::sin(double(a)) - 1));
        cosine = std::max(cosine, std::abs(both.y - std::cos(double(a))));
    }
    EXPECT_LT(sine, 2e-7);
    EXPECT_LT(cosine, 1.3e-7);
}

}  // namespace
}  // namespace nightcity
