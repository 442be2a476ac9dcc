// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The near part of a pane along random rays, against quadrature in double precision.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "airlight_cases.h"
#include "transport/near_window.h"

namespace nightcity {
namespace {

constexpr double kRadius = 4;

struct NearCase {
    PaneFrame pane;
    vec2 chord;
};

// A ray past a pane of 1 to 4 m^2, every other one ends on the wall behind; 30 m away.
NearCase randomCase(RandomNumbers& random) {
    NearCase c;
    do {
        const glm::dvec3 w = random.direction();
        glm::dvec3 through(random.between(-kRadius, kRadius), random.between(-kRadius, kRadius),
                           random.between(0, kRadius));
        through.z *= random.between(0, 1) < 0.5 ? 0 : 1;
        c.pane.a = float(random.between(0.5, 1));
        c.pane.b = float(random.between(0.5, 1));
        c.pane.direction = glm::vec3(w);
        c.pane.origin = glm::vec3(through - 30.0 * w);
        c.chord = nearChord(c.pane, 0, float(kRadius), 0, 1000);
    } while (c.chord.y - c.chord.x < 1e-3f);
    return c;
}

double solidAngle(glm::dvec3 x, double a, double b) {
    const auto corner = [&](double p, double q) {
        return std::atan2(p * q, x.z * std::sqrt(p * p + q * q + x.z * x.z));
    };
    return corner(a - x.x, b - x.y) + corner(a + x.x, b - x.y) + corner(a - x.x, b + x.y) +
           corner(a + x.x, b + x.y);
}

double nearWindow(const NearCase& c, vec2 chord, float begin, float extinction, float tolerance) {
    const NearPass pass = nearPass(c.pane, chord, begin);
    return isNearCut(pass, c.pane, tolerance < 0.005f)
               ? nearAtEdges(pass, c.pane, float(kRadius), extinction, tolerance)
               : nearBeside(pass, c.pane, float(kRadius), extinction, tolerance, extinction == 0);
}

struct Exact {
    double near, whole;  // m sr: with and without the near share
};

// By 200 panels: the attenuation is that of the mean distance, which other tests hold.
Exact exactNear(const NearCase& c, double extinction) {
    constexpr int kPanels = 200;
    const glm::dvec3 w = glm::normalize(glm::dvec3(c.pane.direction));
    const double a = c.pane.a, b = c.pane.b;
    const double span = (double(c.chord.y) - c.chord.x) / kPanels;
    Exact exact{};
    for (int panel = 0; panel < kPanels; ++panel) {
        for (int k = 0; k < 4; ++k) {
            const vec2 node = gaussNode(4, k);
            const double t = c.chord.x + span * (panel + double(node.x));
            glm::dvec3 x = glm::dvec3(c.pane.origin) + t * w;
            x.z = std::max(x.z, 1e-9);
            const double angle = solidAngle(x, a, b);
            const double mean = std::cbrt(4 * a * b * x.z / angle) * (1 - 0.3 * angle / (2 * M_PI));
            const double light = angle * span * double(node.y) *
                                 std::exp(-extinction * (t - c.chord.x + mean));
            const double rest = std::max(1 - glm::dot(x, x) / (kRadius * kRadius), 0.0);
            exact.near += light * rest * rest * rest * (4 - 3 * rest);
            exact.whole += light;
        }
    }
    return exact;
}

ErrorFigures figures(float tolerance, float extinction, int count) {
    RandomNumbers random(7);
    std::vector<double> errors;
    for (int i = 0; i < count; ++i) {
        const NearCase c = randomCase(random);
        const Exact exact = exactNear(c, extinction);
        const double found = nearWindow(c, c.chord, c.chord.x, extinction, tolerance);
        errors.push_back(std::abs(found - exact.near) / exact.whole);
    }
    return errorFigures(errors);
}

// What a window brings to the ball of the radius about it, whatever its lobe: its fluence times the
// square of the distance is the share, so that the mean of that over the distance is 1 without one.
TEST(NearWindow, ABlurKeepsWhatTheBallGets) {
    constexpr int kSteps = 10000;
    double blurred = 0, far = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double u = (i + 0.5) / kSteps;
        blurred += double(blurredShare(float(u * u))) / kSteps;
        far += double(farShare(float(u * u))) / kSteps;
    }
    EXPECT_NEAR(blurred, 1, 1e-5);
    EXPECT_NEAR(far, 1 - 64.0 / 105, 1e-5);
}

TEST(NearWindow, HoldsTheToleranceOnRandomRays) {
    for (const float extinction : {0.0f, 0.05f}) {
        const ErrorFigures percent = figures(0.01f, extinction, 600);
        EXPECT_LT(percent.p50, 0.001);
        EXPECT_LT(percent.p99, 0.01);
        EXPECT_LT(percent.max, 0.1);
        const ErrorFigures thousandth = figures(0.001f, extinction, 600);
        EXPECT_LT(thousandth.p50, 1e-4);
        EXPECT_LT(thousandth.p99, 1.5e-3);
    }
}

// Within 0.3 m of the pane and nearly along it, where the solid angle is a plateau with steep
// flanks.
TEST(NearWindow, HoldsAlongThePane) {
    RandomNumbers random(11);
    for (int i = 0; i < 200; ++i) {
        NearCase c;
        c.pane.a = 0.6f;
        c.pane.b = 0.75f;
        const double turn = random.between(0, 2 * M_PI);
        const glm::dvec3 w = glm::normalize(
            glm::dvec3(std::cos(turn), std::sin(turn), random.between(-0.05, 0.05)));
        const double away = std::pow(10.0, random.between(-2, -0.5));
        const glm::dvec3 through(random.between(-0.5, 0.5), random.between(-0.5, 0.5), away);
        c.pane.direction = glm::vec3(w);
        c.pane.origin = glm::vec3(through - 5.0 * w);
        c.chord = nearChord(c.pane, 0, float(kRadius), 0, 1000);
        const Exact exact = exactNear(c, 0.01);
        const double found = nearWindow(c, c.chord, c.chord.x, 0.01f, 0.01f);
        EXPECT_NEAR(found, exact.near, 0.03 * exact.whole) << "ray " << i;
    }
}

TEST(NearWindow, HasNoChordBehindThePaneOrPastTheRadius) {
    PaneFrame pane{0.6f, 0.75f, {0, 0, -1}, {1, 0, 0}};
    vec2 chord = nearChord(pane, 0, 4, 0, 100);
    EXPECT_LE(chord.y, chord.x);
    pane.origin.z = 4.5f;
    chord = nearChord(pane, 0, 4, 0, 100);
    EXPECT_LE(chord.y, chord.x);
}

TEST(NearWindow, EndsAtThePlaneOfThePane) {
    const PaneFrame pane{0.6f, 0.75f, {0, 0, 10}, {0, 0, -1}};
    const vec2 chord = nearChord(pane, 0, 4, 0, 100);
    EXPECT_FLOAT_EQ(chord.x, 6);
    EXPECT_FLOAT_EQ(chord.y, 10);
}

TEST(NearWindow, EndsAtTheWallBehindAPoint) {
    const PaneFrame pane{0, 0, {0, 0, 10}, {0, 0, -1}};
    EXPECT_FLOAT_EQ(nearChord(pane, 0.5f, 4, 0, 100).y, 10.5f);
    EXPECT_FLOAT_EQ(nearChord(pane, 1e15f, 4, 0, 100).y, 14);
}

// Of a point of light; in the angle under which it sees the ray.
double exactPoint(const NearCase& c, bool hasLobe, double extinction, bool hasShare) {
    constexpr int kPanels = 400;
    const glm::dvec3 w = glm::normalize(glm::dvec3(c.pane.direction));
    const glm::dvec3 origin(c.pane.origin);
    const double delta = -glm::dot(origin, w);
    const double h = glm::length(origin + delta * w);
    const double low = std::atan((c.chord.x - delta) / h);
    const double span = (std::atan((c.chord.y - delta) / h) - low) / kPanels;
    double sum = 0;
    for (int panel = 0; panel < kPanels; ++panel) {
        for (int k = 0; k < 4; ++k) {
            const vec2 node = gaussNode(4, k);
            const double angle = low + span * (panel + double(node.x));
            const double t = delta + h * std::tan(angle);
            const glm::dvec3 x = origin + t * w;
            const double d = glm::length(x);
            const double rest = std::max(1 - d * d / (kRadius * kRadius), 0.0);
            sum += span / h * double(node.y) * (hasLobe ? std::max(x.z, 0.0) / d : 1) *
                   (hasShare ? rest * rest * rest * (4 - 3 * rest) : 1) *
                   std::exp(-extinction * (t - c.chord.x + d));
        }
    }
    return sum;
}

ErrorFigures pointFigures(bool hasLobe, float tolerance) {
    constexpr float kExtinction = 0.05f;
    RandomNumbers random(5);
    std::vector<double> errors;
    for (int i = 0; i < 600; ++i) {
        NearCase c = randomCase(random);
        c.chord = nearChord(c.pane, hasLobe ? 0 : 1e15f, float(kRadius), 0, 1000);
        const double found = nearPoint(c.pane, hasLobe, 0, float(kRadius), c.chord, c.chord.x,
                                       kExtinction, tolerance);
        errors.push_back(std::abs(found - exactPoint(c, hasLobe, double(kExtinction), true)) /
                         exactPoint(c, hasLobe, double(kExtinction), false));
    }
    return errorFigures(errors);
}

TEST(NearWindow, OfPointsHoldsTheToleranceOnRandomRays) {
    for (const bool hasLobe : {false, true}) {
        const ErrorFigures percent = pointFigures(hasLobe, 0.01f);
        EXPECT_LT(percent.p50, 1e-4);
        EXPECT_LT(percent.p99, 5e-3);
        EXPECT_LT(percent.max, 0.02);
        const ErrorFigures thousandth = pointFigures(hasLobe, 0.001f);
        EXPECT_LT(thousandth.p50, 1e-5);
        EXPECT_LT(thousandth.p99, 1.5e-3);
    }
}

TEST(NearWindow, IsTheSumOfItsParts) {
    RandomNumbers random(3);
    for (int i = 0; i < 300; ++i) {
        const NearCase c = randomCase(random);
        const float middle = 0.5f * (c.chord.x + c.chord.y);
        const double whole = nearWindow(c, c.chord, 0, 0.01f, 1e-4f);
        const double parts = nearWindow(c, {c.chord.x, middle}, 0, 0.01f, 1e-4f) +
                             nearWindow(c, {middle, c.chord.y}, 0, 0.01f, 1e-4f);
        EXPECT_NEAR(whole, parts, 2e-3 * whole + 1e-5);
    }
}

}  // namespace
}  // namespace nightcity
