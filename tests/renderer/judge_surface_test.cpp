// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Direct light on surfaces against closed forms.
#include <cmath>

#include <gtest/gtest.h>

#include "judge_setup.h"

namespace nightcity {
namespace {

double irradiance(const FlatScene& scene, const RenderSettings& settings, const SurfacePoint& point,
                  const Accuracy& accuracy = kFine) {
    const LightScene lights(scene, 1, settings);
    return SurfaceLight(lights, accuracy).irradiance(point).value.x;
}

// Two metres before a pane of 1 x 1.5 m, facing it.
const SurfacePoint kOpposite{{0, 2, 0}, {0, -1, 0}, std::nullopt};

// View factor from a small parallel area to a rectangle a x b with one corner above
// it at distance c (Howell, catalogue of configuration factors, B-3).
double cornerFactor(double a, double b, double c) {
    const double x = a / c, y = b / c;
    const double p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
    return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * kPi);
}

TEST(JudgeSurface, PointsFollowTheInverseSquare) {
    SceneBuilder city;
    addFreeWindow(city, {1, 0, 0.5f});
    const FlatScene scene = city.load();
    const double squared = 1 + 4 + 0.25, cosine = 2 / std::sqrt(squared);
    EXPECT_NEAR(irradiance(scene, exactModel(Emitter::isotropic), kOpposite),
                50 * cosine / (4 * kPi * squared), 1e-12);
    EXPECT_NEAR(irradiance(scene, exactModel(Emitter::lambertian), kOpposite),
                50 * cosine * cosine / (kPi * squared), 1e-12);
    const SurfacePoint away{{0, 2, 0}, {0, 1, 0}, std::nullopt};
    EXPECT_EQ(irradiance(scene, exactModel(Emitter::isotropic), away), 0);
}

TEST(JudgeSurface, PaneIsItsViewFactor) {
    SceneBuilder city;
    addFreeWindow(city, {0, 0, 0});
    const FlatScene scene = city.load();
    const auto expected = [](double c) { return 50 / 1.5 * 4 * cornerFactor(0.5, 0.75, c); };
    EXPECT_NEAR(irradiance(scene, exactModel(Emitter::pane), kOpposite) / expected(2), 1, 1e-10);
    // A centimetre away it approaches the pane's exitance P / A.
    const SurfacePoint near{{0, 0.01, 0}, {0, -1, 0}, std::nullopt};
    const double close = irradiance(scene, exactModel(Emitter::pane), near);
    EXPECT_NEAR(close / expected(0.01), 1, 1e-9);
    EXPECT_NEAR(close / (50 / 1.5), 1, 1e-3);
}

// A wall hides all of the pane left of the middle: half of it remains, to rounding.
TEST(JudgeSurface, HalfHiddenPaneIsHalf) {
    SceneBuilder city;
    addFreeWindow(city, {0, 0, 0});
    const double whole = irradiance(city.load(), exactModel(Emitter::pane), kOpposite);
    city.addBoxBuilding({-8, 1, -8}, {0, 1.5f, 8}, city.addMaterial(vec3(0.5f)));
    EXPECT_NEAR(irradiance(city.load(), exactModel(Emitter::pane), kOpposite) / whole, 0.5, 1e-10);
    EXPECT_NEAR(irradiance(city.load(), exactModel(Emitter::pane, Visibility::none), kOpposite) / whole,
                1, 1e-12);
}

TEST(JudgeSurface, HazeDimsTheWay) {
    SceneBuilder city;
    addFreeWindow(city, {0, 0, 0});
    city.addMediaBox({-4, 0.5f, -4}, {4, 1, 4}, 0.25f, 0.5f);
    city.addMediaBox({-4, 1, -4}, {4, 4, 4}, 0.5f, 0.5f);
    const FlatScene scene = city.load();
    const double clear = 50 / (kPi * 4);
    EXPECT_NEAR(irradiance(scene, exactModel(Emitter::lambertian), kOpposite) / clear,
                std::exp(-(0.5 * 0.25 + 1 * 0.5)), 1e-12);
    // Without visibility: the haze of the surface's own box, all the way.
    SurfacePoint point = kOpposite;
    point.box = 1;
    EXPECT_NEAR(irradiance(scene, exactModel(Emitter::lambertian, Visibility::none), point) / clear,
                std::exp(-2 * 0.5), 1e-12);
    RenderSettings off = exactModel(Emitter::lambertian);
    off.media = false;
    EXPECT_NEAR(irradiance(scene, off, point) / clear, 1, 1e-12);
}

TEST(JudgeSurface, LitAddsReflectedLightToWhatIsSeen) {
    SceneBuilder city;
    city.ground = GroundPlane{0, city.addMaterial({0.5f, 0.25f, 0})};
    addFreeWindow(city, {0, 0, 3});
    const FlatScene scene = city.load();
    RenderSettings settings = exactModel(Emitter::isotropic);
    const Ray ray = through({0, 9, 5}, {0, 4, 0});
    const glm::dvec3 dim = ExactIntegral(scene, 1, settings, kFine).trace(ray).surface.radiance;
    settings.model.surfaces = Surfaces::lit;
    const glm::dvec3 lit = ExactIntegral(scene, 1, settings, kFine).trace(ray).surface.radiance;
    const double falling = 50 * (3 / 5.0) / (4 * kPi * 25);
    EXPECT_NEAR(lit.x - dim.x, 0.5 / kPi * falling, 1e-12);
    EXPECT_NEAR(lit.y - dim.y, 0.25 / kPi * falling, 1e-12);
    EXPECT_EQ(lit.z, 0);
}

}  // namespace
}  // namespace nightcity
