// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// A pane's solid angle and its air light, from a centimetre to 128 sides away.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "airlight_cases.h"

namespace nightcity {
namespace {

double exactAngle(glm::dvec3 x, double a, double b) {
    const auto corner = [&](double p, double q) {
        return std::atan2(p * q, x.z * std::sqrt(p * p + q * q + x.z * x.z));
    };
    return corner(a - x.x, b - x.y) + corner(a + x.x, b - x.y) + corner(a - x.x, b + x.y) +
           corner(a + x.x, b + x.y);
}

double paneError(const PaneCase& c, float tolerance) {
    const double value = airlightPane(c.fromCentre, c.direction, c.halfU, c.halfV, c.begin, c.end,
                                      c.extinction, tolerance);
    const double error = std::abs(value / exactPane(c) - 1);
    return std::isnan(error) ? 1e30 : error;
}

PaneCase paneCase(vec3 fromCentre, vec3 direction, float end, float extinction) {
    return {fromCentre, glm::normalize(direction), vec3(0.6f, 0, 0), vec3(0, 0.75f, 0), 0, end,
            extinction};
}

TEST(PaneSolidAngle, AgreesWithTheCornersInDoublePrecision) {
    RandomNumbers random(21);
    double far = 0, near = 0;
    for (int k = 0; k < 200000; ++k) {
        const double distance = random.logBetween(0.01, 200);
        const glm::dvec3 away = random.direction();
        const vec3 x(random.between(-0.6, 0.6) + distance * away.x,
                     random.between(-0.75, 0.75) + distance * away.y,
                     std::max(0.01, std::abs(distance * away.z)));
        const double exact = exactAngle(glm::dvec3(x), 0.6f, 0.75f);
        const double error = std::abs(paneSolidAngle(x, 0.6f, 0.75f) / exact - 1);
        (distance > 1.5 ? far : near) = std::max(distance > 1.5 ? far : near, error);
    }
    EXPECT_LT(far, 3e-6);
    EXPECT_LT(near, 5e-5);
}

TEST(PaneSolidAngle, IsAHalfSpaceOnThePane) {
    for (const float z : {1e-3f, 1e-4f, kPaneNearest}) {
        EXPECT_NEAR(paneSolidAngle(vec3(0.2f, -0.3f, z), 0.6f, 0.75f), 2 * std::numbers::pi, 0.02);
        EXPECT_LT(paneSolidAngle(vec3(0.9f, -0.3f, z), 0.6f, 0.75f), 20 * z);
    }
}

TEST(AirlightPane, KeepsItsToleranceWithoutHaze) {
    RandomNumbers random(22);
    std::vector<PaneCase> cases;
    for (int k = 0; k < 4000; ++k) {
        cases.push_back(randomPaneCase(random, 0));
    }
    for (const float tolerance : {0.1f, 0.01f, 0.001f}) {
        std::vector<double> errors;
        for (const PaneCase& c : cases) {
            errors.push_back(paneError(c, tolerance));
        }
        const ErrorFigures e = errorFigures(errors);
        EXPECT_LT(e.p99, 0.25 * tolerance);
        EXPECT_LT(e.p999, tolerance);
        EXPECT_LT(e.max, 5 * tolerance);
    }
}

TEST(AirlightPane, KeepsItsToleranceInHaze) {
    for (const double extinction : {0.01, 0.1}) {
        RandomNumbers random(23);
        for (const float tolerance : {0.1f, 0.01f}) {
            std::vector<double> errors;
            for (int k = 0; k < 12; ++k) {
                errors.push_back(paneError(randomPaneCase(random, extinction), tolerance));
            }
            EXPECT_LT(errorFigures(errors).max, tolerance);
        }
    }
}

TEST(AirlightPane, GrazingACentimetreAway) {
    for (const float slope : {0.0f, 1e-3f, 0.01f, 0.1f}) {
        const PaneCase c = paneCase(vec3(-5, 0.2f, 0.01f), vec3(1, 0.02f, slope), 12, 0);
        EXPECT_LT(paneError(c, 0.01f), 0.01) << slope;
    }
}

TEST(AirlightPane, ThroughThePane) {
    for (const vec3 target : {vec3(0), vec3(0.59f, 0, 0), vec3(0.3f, 0.7499f, 0)}) {
        const vec3 eye(3, -2, 8);
        const PaneCase c = paneCase(eye, target - eye, 30, 0);
        EXPECT_LT(paneError(c, 0.01f), 0.01);
    }
}

TEST(AirlightPane, NothingBehind) {
    const PaneCase c = paneCase(vec3(-5, 0.2f, -0.01f), vec3(1, 0, 0), 12, 0.01f);
    EXPECT_EQ(airlightPane(c.fromCentre, c.direction, c.halfU, c.halfV, 0, 12, 0.01f, 0.01f), 0);
}

// No step where the method changes: from near to far, from far to point.
TEST(AirlightPane, NoStepWhereTheMethodChanges) {
    const float tolerance = 0.01f;
    double last = 0;
    for (double distance = 0.5; distance < 60; distance *= 1.0005) {
        const PaneCase c = paneCase(vec3(-20, 0.3f, distance), vec3(1, 0.1f, 0), 45, 0.01f);
        const double value = airlightPane(c.fromCentre, c.direction, c.halfU, c.halfV, 0, 45,
                                          0.01f, tolerance);
        if (last > 0) {
            EXPECT_NEAR(value / last, 1, 0.002 + 0.7 * tolerance) << distance;
        }
        last = value;
    }
}

TEST(AirlightPane, IsAPointFromAfar) {
    const vec3 from(-20, 0.3f, 200), direction(1, 0, 0);
    const float point = airlightLambertian(airlightInterval(from, direction, 0, 45), direction,
                                           vec3(0, 0, 1), 0.01f, 0.001f);
    const float pane = airlightPane(from, direction, vec3(0.6f, 0, 0), vec3(0, 0.75f, 0), 0, 45,
                                    0.01f, 0.001f);
    EXPECT_NEAR(pane / point, 1, 1e-3);
}

}  // namespace
}  // namespace nightcity
