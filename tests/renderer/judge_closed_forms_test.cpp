// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Whole scenes whose glow is known: panes, planes of lights, hazes, shadows.
#include <cmath>

#include <gtest/gtest.h>

#include "exponential_integral.h"
#include "judge_setup.h"

namespace nightcity {
namespace {

// Solid angle of a rectangle centred on the z axis, seen from (x, y, z): four
// corner terms atan2(x y, z sqrt(x^2 + y^2 + z^2)).
double solidAngle(double halfX, double halfY, glm::dvec3 eye) {
    const auto corner = [&](double x, double y) {
        return std::atan2(x * y, eye.z * std::sqrt(x * x + y * y + eye.z * eye.z));
    };
    const double x0 = -halfX - eye.x, x1 = halfX - eye.x, y0 = -halfY - eye.y, y1 = halfY - eye.y;
    return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
}

// Haze so thin that it does not dim, about a pane of 1 x 1.5 m at the origin that
// shines along +y.
SceneBuilder thinHazeAndPane() {
    SceneBuilder city;
    addFreeWindow(city, {0, 0, 0});
    city.addMediaBox(vec3(-64), vec3(64), 1e-14f, 0.9f);
    return city;
}

// Glow of the pane by its solid angle: a plain one-dimensional integral.
double paneByAngle(const SceneBuilder& city, const Ray& ray, double begin, double end) {
    std::vector<double> breaks;
    for (int i = 0; i <= 64; ++i) {
        breaks.push_back(begin + (end - begin) * i / 64);
    }
    const auto angle = [&](double t) {
        const glm::dvec3 p = ray.at(t);
        return p.y > 0 ? solidAngle(0.5, 0.75, {p.x, p.z, p.y}) : 0.0;
    };
    return phaseScattering(city) * 50 / (kPi * 1.5) * integrate(angle, breaks, {0, 1e-12}).value;
}

TEST(JudgeClosedForms, PaneIsItsSolidAngle) {
    const SceneBuilder city = thinHazeAndPane();
    const FlatScene scene = city.load();
    const auto expectPane = [&](const Ray& ray, double begin, double end, double wanted,
                                const Accuracy& accuracy) {
        const double expected = paneByAngle(city, ray, begin, end);
        EXPECT_NEAR(glow(scene, exactModel(Emitter::pane), ray, accuracy) / expected, 1, wanted);
    };
    // Past it at 8 m; obliquely away from it; and from beside it.
    expectPane({{-64, 8, 0.5}, {1, 0, 0}}, 0, 128, 1e-9, {3e-10, 1e-12});
    const Ray away = through({1, 3, -2}, {4, 9, 1});
    expectPane(away, 0, (64 - 3) / away.direction.y, 1e-9, {1e-9, 1e-12});
    // Near: 5 cm before it, and through it.
    expectPane({{-64, 0.05, 0.1}, {1, 0, 0}}, 0, 128, 1e-5, {1e-5, 1e-12});
    expectPane({{0.1, 20, 0.2}, {0, -1, 0}}, 0, 20, 1e-5, {1e-5, 1e-12});
    expectPane(through({3, 5, 1}, {0.2, 0, 0.3}), 0, glm::length(glm::dvec3(2.8, 5, 0.7)), 1e-5,
               {1e-5, 1e-12});
}

TEST(JudgeClosedForms, PaneSeenFromAfarIsACosineLobe) {
    const FlatScene scene = thinHazeAndPane().load();
    const Ray ray = through({-60, 50, 3}, {60, 55, 3});
    const double pane = glow(scene, exactModel(Emitter::pane), ray, {1e-8, 1e-12});
    const double point = glow(scene, exactModel(Emitter::lambertian), ray);
    EXPECT_NEAR(pane / point, 1, 3e-4);
    EXPECT_NE(pane, point);
}

// A wide Lambertian plane: fluence 2 pi L E2(tau z), L = P / (pi A). Beyond 60
// optical depths to the border it has no end.
TEST(JudgeClosedForms, WidePanelIsAFurnace) {
    SceneBuilder city;
    const float half = 128;
    city.addWindow({0, 0, 0}, {half, 0, 0}, {0, half, 0}, 1e6f, vec3(1), false);
    city.addMediaBox({-160, -160, -1}, {160, 160, 60}, 0.5f, 0.8f);
    const double tau = 0.5, z = 3, length = 4;
    const double e2 = std::exp(-tau * z) - tau * z * exponentialIntegral(tau * z).real();
    city.addBoxBuilding({4, -1, 2}, {5, 1, 4}, city.addMaterial(vec3(0)));  // ends the ray
    SceneBuilder open = city;
    open.triangles.clear();
    open.buildings.clear();
    const double radiance = 1e6 / (kPi * 4 * half * half);
    const double expected =
        phaseScattering(city) * 2 * kPi * radiance * e2 * -std::expm1(-tau * length) / tau;
    // The building only ends the ray here: without visibility it casts no shadow.
    EXPECT_NEAR(glow(city.load(), exactModel(Emitter::pane, Visibility::none), {{0, 0, z}, {1, 0, 0}},
                     {1e-6, 1e-12}) / expected, 1, 1e-6);
    const double all = 2 * kPi * phaseScattering(city) * radiance * e2 / tau;
    EXPECT_NEAR(glow(open.load(), exactModel(Emitter::pane), {{-40, 0, z}, {1, 0, 0}},
                     {1e-6, 1e-12}) / all, 1, 1e-6);
}

// Isotropic lights of p watts a square metre: fluence (p / 2) E1(tau z). An array
// with spacing s is the plane to exp(-2 pi z / s), here 1e-11; 30 optical depths to
// its border.
TEST(JudgeClosedForms, ArrayOfLightsIsAPlane) {
    SceneBuilder city;
    for (int y = -60; y <= 60; ++y) {
        for (int x = -60; x <= 60; ++x) {
            addFreeWindow(city, {x, y, 0}, 1, 0.25f, 0.25f, 2);
        }
    }
    const double tau = 0.5, z = 4;
    city.addMediaBox({-80, -80, -1}, {8, 80, 16}, 0.5f, 0.8f);
    const double fluence = 2 / 2.0 * exponentialIntegral(tau * z).real();
    const double expected = phaseScattering(city) * fluence * -std::expm1(-tau * 10) / tau;
    EXPECT_NEAR(glow(city.load(), exactModel(Emitter::isotropic, Visibility::none),
                     {{-2, 0.3, z}, {1, 0, 0}}, {1e-10, 1e-12}) / expected, 1, 1e-9);
}

TEST(JudgeClosedForms, OneLightInHazeMeetsTheExponentialIntegral) {
    SceneBuilder city;
    addFreeWindow(city, {3, 4, 0});
    city.addMediaBox({-16, -16, -16}, {16, 16, 16}, 0.0625f, 0.5f);
    const double expected = phaseScattering(city) * 50 / (4 * kPi) *
                            airlightOracle(0.0625, 4, 19, 0, 32).value;
    const Ray ray{{-50, 0, 0}, {1, 0, 0}};
    EXPECT_NEAR(glow(city.load(), exactModel(Emitter::isotropic), ray) / expected, 1, 1e-10);
}

// Light at the origin, a wall between x = 1 and 2, |y| < 1: on the line x = 4 the
// front edges (1, +-1) throw their shadow to y = +-4.
TEST(JudgeClosedForms, ShadowOfOneBox) {
    SceneBuilder city;
    addFreeWindow(city, {0, 0, 0});
    city.addMediaBox({-16, -10, -16}, {16, 10, 16}, 1e-14f, 0.9f);
    city.addBoxBuilding({1, -1, -8}, {2, 1, 8}, city.addMaterial(vec3(0)));
    const FlatScene scene = city.load();
    const Ray ray{{4, -30, 0}, {0, 1, 0}};
    const double lit = 2 * (std::atan(10 / 4.0) - std::atan(4 / 4.0)) / 4;
    const double expected = phaseScattering(city) * 50 / (4 * kPi) * lit;
    EXPECT_NEAR(glow(scene, exactModel(Emitter::isotropic), ray) / expected, 1, 1e-11);
    const double unshadowed = 2 * std::atan(10 / 4.0) / 4;
    EXPECT_NEAR(glow(scene, exactModel(Emitter::isotropic, Visibility::none), ray) / expected,
                unshadowed / lit, 1e-11);
    // The pane's own plane y = 0 leaves the half y > 0 of the ray, with the same edge.
    const auto primitive = [](double y) { return -1 / std::hypot(4.0, y); };  // of y / d^3
    const double front = phaseScattering(city) * 50 / kPi * (primitive(10) - primitive(4));
    EXPECT_NEAR(glow(scene, exactModel(Emitter::lambertian), ray) / front, 1, 1e-11);
}

TEST(JudgeClosedForms, WalledCourtyardIsExactlyDark) {
    SceneBuilder city;
    const uint wall = city.addMaterial(vec3(0));
    city.addBoxBuilding({-6, -6, 0}, {-5, 6, 20}, wall);
    city.addBoxBuilding({5, -6, 0}, {6, 6, 20}, wall);
    city.addBoxBuilding({-5, -6, 0}, {5, -5, 20}, wall);
    city.addBoxBuilding({-5, 5, 0}, {5, 6, 20}, wall);
    city.ground = GroundPlane{0, wall};
    addFreeWindow(city, {0, 4.5f, 3}, -1);
    addFreeWindow(city, {1, -4.5f, 7});
    city.addMediaBox({-40, -40, 0}, {40, 40, 20}, 0.01f, 0.9f);
    const FlatScene scene = city.load();
    for (const Emitter emitter : {Emitter::isotropic, Emitter::lambertian, Emitter::pane}) {
        for (const Ray& ray : {through({-60, -50, 3}, {60, -9, 19}), through({-8, -30, 1}, {-8.5, 30, 19.9}),
                               through({30, 30, 60}, {12, 10, 0}), through({-60, 0, 10}, {-6, 0, 10})}) {
            EXPECT_EQ(glow(scene, exactModel(emitter), ray, {1e-4, 1e-6}), 0);
        }
        EXPECT_GT(glow(scene, exactModel(emitter), through({0, 0, 60}, {0, 0, 0}), {1e-4, 1e-6}), 0);
    }
}

TEST(JudgeClosedForms, GroundHidesWhatLiesBelow) {
    SceneBuilder city;
    city.ground = GroundPlane{0, city.addMaterial(vec3(0.5f))};
    addFreeWindow(city, {0, 3, -2});
    city.addMediaBox({-20, -20, -20}, {20, 20, 20}, 0.01f, 0.9f);
    const FlatScene scene = city.load();
    for (const Emitter emitter : {Emitter::isotropic, Emitter::lambertian, Emitter::pane}) {
        EXPECT_EQ(glow(scene, exactModel(emitter), through({0, 10, 15}, {1, 5, 0}), {1e-4, 1e-6}), 0);
    }
}

}  // namespace
}  // namespace nightcity
