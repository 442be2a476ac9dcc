// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The line integral of one light against closed forms, in double precision.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "exponential_integral.h"
#include "judge_setup.h"
#include "reference/airlight.h"

namespace nightcity {
namespace {

const Tolerance kExact{0, 1e-12};

// Along x from the origin, one haze all the way; an isotropic light at (foot, h, 0).
// Times 16 pi^2 / scattering: the bare integral of exp(-extinction (t + d)) / d^2.
double bareIntegral(double extinction, double h, double foot, double begin, double end) {
    const Ray ray{{0, 0, 0}, {1, 0, 0}};
    const HazeStretch stretch{0, end, extinction, 1, 0};
    const PointSource light{{foot, h, 0}, {0, 0, 0}, Lobe::isotropic, 0};
    const Estimate estimate = airlight(ray, stretch, begin, end, light,
                                       SourceDepth::uniform(extinction), kExact);
    return estimate.value * 16 * kPi * kPi;
}

TEST(JudgeAirlight, OracleMeetsTheInfiniteLine) {
    // Of an infinite line 2 / h f(tau h) remains, f(T) = Ci(T) sin T + (pi/2 - Si(T)) cos T
    // = integral over [0, pi/2] of exp(-T tan x) (Abramowitz and Stegun 5.2.12, 5.2.13).
    for (const double tau : {0.01, 0.3, 2.0}) {
        const double h = 1.5;
        const double breaks[] = {0.0, 0.3, 0.8, 1.2, kPi / 2};
        const double f = integrate([&](double x) { return std::exp(-tau * h * std::tan(x)); },
                                   breaks, {0, 1e-13}).value;
        const double z = airlightOracle(tau, h, 0, -1e13, 1e5 / tau).value;
        EXPECT_NEAR(z / (2 / h * f), 1, 1e-11) << tau;
    }
}

TEST(JudgeAirlight, RandomLightsMeetTheExponentialIntegral) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    double worst = 0;
    int checked = 0;
    for (int i = 0; i < 20000; ++i) {
        const double tau = std::pow(10, -4 + 4 * unit(random));
        const double h = std::pow(10, -2 + 4 * unit(random));
        const double length = 3 * std::pow(2000.0 / 3, unit(random));
        const double foot = length * (1.5 * unit(random) - 0.25);
        const OracleValue oracle = airlightOracle(tau, h, foot, 0, length);
        if (oracle.value < 1e-280 || oracle.rounding > 1e-10 * oracle.value) {
            continue;
        }
        worst = std::max(worst, std::abs(bareIntegral(tau, h, foot, 0, length) / oracle.value - 1));
        ++checked;
    }
    EXPECT_LT(worst, 2e-10);
    EXPECT_GT(checked, 15000);
}

TEST(JudgeAirlight, WithoutExtinctionItIsAnAngle) {
    for (const double h : {1e-9, 1e-6, 1e-3, 0.1, 1.0, 30.0}) {
        for (const double foot : {-7.0, 0.0, 40.0, 1e4}) {
            const double begin = foot == 0 ? 1e-3 : 0, end = 1e4 + 1;
            const double expected =
                (std::atan2(h, begin - foot) - std::atan2(h, end - foot)) / h;
            EXPECT_NEAR(bareIntegral(0, h, foot, begin, end) / expected, 1, 1e-9) << h << " " << foot;
        }
    }
    // A metre, ten kilometres away: angles that differ in their last digits.
    EXPECT_NEAR(bareIntegral(0, 0.1, 0, 1e4, 1e4 + 1) * 1e4 * (1e4 + 1), 1, 1e-9);
}

TEST(JudgeAirlight, ThinHazeIsContinuous) {
    const double clear = bareIntegral(0, 2, 30, 0, 100);
    for (const double tau : {1e-12, 1e-9, 1e-6}) {
        const double value = bareIntegral(tau, 2, 30, 0, 100);
        EXPECT_LT(value, clear);
        EXPECT_NEAR(value / clear, 1, 200 * tau + 1e-13);
    }
}

TEST(JudgeAirlight, LightOnTheLineBehindTheStart) {
    // h = 0, u = t - foot > 0: exp(-tau foot) {[-exp(-2 tau u) / u] - 2 tau (E1 - E1)}.
    for (const double tau : {0.001, 0.05, 3.0}) {
        const double foot = -2.5, a = 2.5, b = 42.5;
        const auto e1 = [&](double u) { return exponentialIntegral(2 * tau * u).real(); };
        const double expected =
            std::exp(-tau * foot) * (std::exp(-2 * tau * a) / a - std::exp(-2 * tau * b) / b -
                                     2 * tau * (e1(a) - e1(b)));
        EXPECT_NEAR(bareIntegral(tau, 0, foot, 0, 40) / expected, 1, 1e-10) << tau;
    }
    EXPECT_EQ(bareIntegral(0.1, 0, 5, 0, 10), std::numeric_limits<double>::infinity());
}

TEST(JudgeAirlight, CosineLobeInClearAir) {
    // cos / d^2 = (n.f + u n.w) / d^3: [n.f u / (h^2 d) - n.w / d].
    const Ray ray{{0, 0, 0}, {1, 0, 0}};
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.8, -0.8, 0.2));
    const double h = 3, foot = 5, length = 30;
    const PointSource light{{foot, h, 0}, normal, Lobe::cosine, 0};
    const double atFoot = glm::dot(normal, glm::dvec3(0, -h, 0));
    const double dark = foot - atFoot / normal.x;  // where the ray crosses the lobe's plane
    ASSERT_GT(dark, 0);
    ASSERT_LT(dark, foot);
    const auto primitive = [&](double t) {
        const double u = t - foot, d = std::hypot(h, u);
        return atFoot * u / (h * h * d) - normal.x / d;
    };
    const double expected = (primitive(length) - primitive(dark)) / (4 * kPi * kPi);
    const HazeStretch stretch{0, length, 0, 1, 0};
    const Estimate found = airlight(ray, stretch, 0, length, light, SourceDepth::uniform(0), kExact);
    EXPECT_NEAR(found.value / expected, 1, 1e-11);
    EXPECT_LE(found.error, 1e-12 * found.value);
}

TEST(JudgeAirlight, SphereShinesOutsideItsRadiusOnly) {
    const Ray ray{{0, 0, 0}, {1, 0, 0}};
    const double h = 0.3, radius = 0.5, foot = 5;
    const PointSource sphere{{foot, h, 0}, {0, 0, 0}, Lobe::isotropic, radius};
    const HazeStretch stretch{0, 10, 0, 1, 0};
    const double angle = std::atan2(h, 0.4);  // the ray enters the ball 0.4 m before the foot
    const double expected = 2 * (angle - std::atan2(h, 5.0)) / h / (16 * kPi * kPi);
    EXPECT_NEAR(airlight(ray, stretch, 0, 10, sphere, SourceDepth::uniform(0), kExact).value / expected,
                1, 1e-11);
}

// Emission p everywhere, seen along a stretch: scattering / 4 pi p / tau (1 - exp(-tau l)) / tau.
// Every light's part integrated over all places of the light, in cylinder coordinates
// about the ray. The same identity is the energy balance: what a light sends into
// the haze is collided there, the integral of tau phi over all space is its power.
TEST(JudgeAirlight, UniformEmissionFillsTheHaze) {
    const double tau = 0.7, length = 2;
    const Tolerance tolerance{0, 1e-11};
    const double radii[] = {0.0, 0.1, 0.5, 1.0, 3.0, 10.0, 45.0};
    const double total = integrate(
        [&](double h) {
            const double places[] = {-40.0, -10.0, -2.0, -0.2, 0.0, 1.0, length, 2.2, 4.0, 12.0, 42.0};
            return 2 * kPi * h * integrate([&](double foot) { return bareIntegral(tau, h, foot, 0, length); },
                                           places, {1e-13, 1e-11}).value;
        },
        radii, tolerance).value;
    const double expected = 4 * kPi / tau * -std::expm1(-tau * length) / tau;
    EXPECT_NEAR(total / expected, 1, 1e-9);
}

}  // namespace
}  // namespace nightcity
