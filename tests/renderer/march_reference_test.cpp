// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "reference/march.h"
#include "reference/reference_renderer.h"
#include "scene_builder.h"

namespace nightcity {
namespace {

constexpr double kPi = std::numbers::pi;

RenderSettings steps(std::uint32_t count) {
    RenderSettings settings;
    settings.subdivisions = count;
    return settings;
}

Ray through(glm::dvec3 from, glm::dvec3 to) {
    return {from, glm::normalize(to - from)};
}

// One light of 50 W in a box of haze, no surfaces.
SceneBuilder oneLight(vec3 lo, vec3 hi, float extinction, vec3 light) {
    SceneBuilder city;
    city.addWindow(light, {0.5f, 0, 0}, {0, 0, 0.5f}, 50, {1, 0.5f, 0.25f}, false);
    city.addMediaBox(lo, hi, extinction, 0.9f, {0});
    city.addCamera("side", {0, -20, 0}, {0, 0, 0}, 40);
    return city;
}

// As tau -> 0 the line integral of 1 / d^2 is (theta_b - theta_a) / h, with h the
// distance of the ray from the light and theta the angles at the light.
TEST(MarchReference, OneLightInThinHazeFollowsTheClosedForm) {
    const float tau = 1e-9f;
    const double h = 1.5;
    const FlatScene scene = oneLight({-10, -10, -10}, {10, 10, 10}, tau, {2, 0, 3}).load();
    const Ray ray = through({-30, h, 3}, {0, h, 3});
    const double expected = double(tau) * double(0.9f) / (4 * kPi) * 50 / (4 * kPi) *
                            (std::atan(8 / h) - std::atan(-12 / h)) / h;
    const RayResult result = March(scene, 1, steps(4000)).trace(ray);
    EXPECT_NEAR(result.glow.x / expected, 1, 2e-6);
    EXPECT_NEAR(result.glow.y / result.glow.x, 0.5, 1e-12);
    EXPECT_NEAR(result.glow.z / result.glow.x, 0.25, 1e-12);
    EXPECT_EQ(result.lightEvaluations, 4000u);
}

// With extinction: Simpson's rule over the same integrand, written out apart.
TEST(MarchReference, OneLightInThickHazeAgreesWithSimpson) {
    const float tau = 0.2f;
    const FlatScene scene = oneLight({-10, -10, -10}, {10, 10, 10}, tau, {2, 0, 3}).load();
    const auto integrand = [&](double t) {  // t from the box's face at x = -10
        const double x = -10 + t - 2, d = std::hypot(x, 1.5);
        return std::exp(-double(tau) * (t + d)) / (d * d);
    };
    const int n = 20000;
    double sum = integrand(0) + integrand(20);
    for (int i = 1; i < n; ++i) {
        sum += (i % 2 ? 4 : 2) * integrand(20.0 * i / n);
    }
    const double expected = sum * 20 / n / 3 * double(tau) * double(0.9f) / (4 * kPi) * 50 / (4 * kPi);
    const RayResult result = March(scene, 1, steps(20000)).trace(through({-30, 1.5, 3}, {0, 1.5, 3}));
    EXPECT_NEAR(result.glow.x / expected, 1, 1e-7);
    EXPECT_NEAR(result.transmittance, std::exp(-20 * double(tau)), 1e-14);
}

TEST(MarchReference, MidpointRuleConvergesWithTheSquareOfTheSteps) {
    const FlatScene scene = oneLight({-10, -10, -10}, {10, 10, 10}, 0.05f, {0, 0, 4}).load();
    const Ray ray = through({-30, 0, 0}, {0, 0, 0});
    const double fine = March(scene, 1, steps(20000)).trace(ray).glow.x;
    const double coarse = March(scene, 1, steps(50)).trace(ray).glow.x - fine;
    const double twice = March(scene, 1, steps(100)).trace(ray).glow.x - fine;
    EXPECT_NEAR(coarse / twice, 4, 0.2);
}

// Boxes in a row, each thicker than the one before: exp(-sum tau l).
TEST(MarchReference, TransmittanceOfSeveralBoxes) {
    SceneBuilder city;
    double depth = 0;
    for (int i = 0; i < 12; ++i) {
        const float tau = 0.01f * float(i + 1);
        city.addMediaBox({float(i) * 2, -1, -1}, {float(i) * 2 + 2, 1, 1}, tau, 0.5f);
        depth += 2 * double(tau);
    }
    const FlatScene scene = city.load();
    const March march(scene, 1, steps(1));
    EXPECT_NEAR(march.trace(through({-5, 0, 0}, {1, 0, 0})).transmittance, std::exp(-depth), 1e-14);
    EXPECT_EQ(march.trace(through({-5, 0, 0}, {1, 0, 0})).mediaId, 0);
    EXPECT_EQ(march.trace(through({50, 0, 0}, {1, 0, 0})).mediaId, 11);
    EXPECT_EQ(march.trace(through({-5, 2, 0}, {1, 2, 0})).mediaId, -1);
}

// A grid of boxes against one box of the same haze: no part of a ray is missed or
// counted twice, whether it runs along faces, edges, through corners or at random.
class BoxGrid : public testing::Test {
protected:
    static constexpr float kTau = 0.03f;

    BoxGrid() {
        SceneBuilder cut, whole;
        for (int z = 0; z < 3; ++z) {
            for (int y = 0; y < 4; ++y) {
                for (int x = 0; x < 5; ++x) {
                    const vec3 lo(float(x) * 10 - 20, float(y) * 10 - 10, float(z) * 10);
                    cut.addMediaBox(lo, lo + 10.0f, kTau, 0.9f);
                }
            }
        }
        whole.addMediaBox({-20, -10, 0}, {30, 30, 30}, kTau, 0.9f);
        cut_ = cut.load();
        whole_ = whole.load();
    }

    void expectEqual(const Ray& ray) {
        const double many = March(cut_, 1, steps(1)).trace(ray).transmittance;
        const double one = March(whole_, 1, steps(1)).trace(ray).transmittance;
        EXPECT_NEAR(many, one, 1e-12) << ray.origin.x << " " << ray.origin.y << " " << ray.origin.z
                                      << " along " << ray.direction.x << " " << ray.direction.y
                                      << " " << ray.direction.z;
    }

    FlatScene cut_, whole_;
};

TEST_F(BoxGrid, RaysAlongFacesAndEdges) {
    expectEqual({{-50, 10, 5}, {1, 0, 0}});    // in a face between two layers
    expectEqual({{-50, 10, 10}, {1, 0, 0}});   // along an edge of four boxes
    expectEqual({{-50, -10, 5}, {1, 0, 0}});   // in the lower outer face: inside
    expectEqual({{-50, 30, 5}, {1, 0, 0}});    // in the upper outer face: outside
    expectEqual({{-50, -10, 0}, {1, 0, 0}});   // along the lowest edge
    expectEqual({{0, 0, 50}, {0, 0, -1}});
    expectEqual({{30, 30, 50}, {0, 0, -1}});
    expectEqual({{0, 0, 10}, {1, 0, 0}});      // camera on a corner of eight boxes
    expectEqual({{0, 5, 15}, {1, 0, 0}});      // camera on a face, looking in
    expectEqual({{0, 5, 15}, {-1, 0, 0}});     // and out
    expectEqual({{0, 5, 15}, {0, 1, 0}});      // and along it
}

TEST_F(BoxGrid, RaysThroughCorners) {
    const double s = 1 / std::sqrt(3.0);
    expectEqual({{-30, -20, -10}, {s, s, s}});
    expectEqual({{-50, -40, -30}, {s, s, s}});
    expectEqual({{0, 0, 0}, {s, s, s}});
    expectEqual(through({-20, -10, 0}, {30, 30, 30}));
    expectEqual({{-40, 5, 15}, glm::normalize(glm::dvec3(1, 1, 0))});
}

TEST_F(BoxGrid, RandomRaysAndCamerasOnTheGrid) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 direction = glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)));
        expectEqual({40.0 * glm::dvec3(unit(random), unit(random), unit(random)), direction});
        const glm::dvec3 corner(10.0 * int(random() % 6) - 20, 10.0 * int(random() % 5) - 10,
                                10.0 * int(random() % 4));
        expectEqual({corner, direction});
    }
}

TEST(MarchReference, BuildingInsideABoxOfHazeEndsIt) {
    SceneBuilder city;
    city.addBoxBuilding({0, -1, -1}, {2, 1, 1}, city.addMaterial({0.5f, 0.25f, 1}));
    city.addMediaBox({-10, -10, -10}, {10, 10, 10}, 0.1f, 0.9f);
    const FlatScene scene = city.load();
    const RayResult result = March(scene, 1, steps(1)).trace(through({-10, 0, 0}, {0, 0, 0}));
    EXPECT_NEAR(result.transmittance, std::exp(-10 * double(0.1f)), 1e-12);
    EXPECT_EQ(result.surface.normal, glm::dvec3(-1, 0, 0));
    EXPECT_NEAR(result.surface.radiance.y, 0.025, 1e-9);
    EXPECT_EQ(result.surface.materialId, 0);
}

TEST(MarchReference, PanesShineToTheFrontOnly) {
    SceneBuilder city;
    city.addBoxBuilding({0, 0, 0}, {10, 10, 10}, city.addMaterial(vec3(0.5f)));
    city.addWindow({5, -0.01f, 5}, {0.6f, 0, 0}, {0, 0, 0.75f}, 50, {1, 0.5f, 0});
    city.addWindow({2, -0.01f, 5}, {0.6f, 0, 0}, {0, 0, 0.75f});
    city.windows[1].flags = 0;                                             // dark
    city.addWindow({5, -5, 20}, {1, 0, 0}, {0, 0, 1}, 50, vec3(1), false);  // in the air
    const FlatScene scene = city.load();
    const OpaqueSurfaces surfaces(scene, 1);
    const SurfaceHit lit = surfaces.nearest(through({5, -8, 5}, {5, 0, 5}));
    EXPECT_NEAR(lit.radiance.x, 50 / (kPi * 1.8), 1e-5);
    EXPECT_NEAR(lit.radiance.y, 25 / (kPi * 1.8), 1e-5);
    EXPECT_NEAR(lit.distance, 7.99, 1e-6);
    EXPECT_EQ(lit.materialId, -1);
    EXPECT_EQ(surfaces.nearest(through({2, -8, 5}, {2, 0, 5})).radiance, glm::dvec3(0));
    EXPECT_NEAR(surfaces.nearest(through({8, -8, 5}, {8, 0, 5})).radiance.x, 0.05, 1e-9);
    EXPECT_GT(surfaces.nearest(through({5, -8, 20}, {5, 0, 20})).radiance.x, 3);
    const SurfaceHit back = surfaces.nearest(through({5, 8, 20}, {5, 0, 20}));
    EXPECT_EQ(back.radiance, glm::dvec3(0));
    EXPECT_NEAR(back.distance, 13, 1e-6);
    EXPECT_EQ(back.normal, glm::dvec3(0, 1, 0));
}

TEST(MarchReference, TextureIsBilinearInLinearLightAndRepeats) {
    SceneBuilder city;
    city.materials.push_back({vec3(1), 0, 2, 1});
    city.texels = {0xff000000u, 0xffbcbcbcu};  // black, then sRGB 188: 0.5029 linear
    city.positions = {{0, 0, 0}, {4, 0, 0}, {4, 0, 4}};
    city.texcoords = {{0, 0}, {4, 0}, {4, 4}};
    city.triangles = {{{0, 1, 2}, 0}};
    const FlatScene scene = city.load();
    const OpaqueSurfaces surfaces(scene, 1);
    const auto seen = [&](double x) {
        return surfaces.nearest(through({x, -5, 0.1}, {x, 0, 0.1})).radiance.x / 0.1;
    };
    EXPECT_NEAR(seen(1.25), 0, 1e-12);             // centre of the left texel
    EXPECT_NEAR(seen(1.75), 0.502886458, 1e-8);    // of the right one
    EXPECT_NEAR(seen(1.5), 0.502886458 / 2, 1e-8); // between them
    EXPECT_NEAR(seen(2.0), 0.502886458 / 2, 1e-8); // across the repeat
}

TEST(MarchReference, LightCapKeepsTheFirstLitWindows) {
    SceneBuilder city;
    for (int i = 0; i < 4; ++i) {
        city.addWindow({float(i), 3, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}, 50, vec3(i == 1, i == 2, i == 3), false);
    }
    city.windows[1].flags = 0;
    city.addMediaBox(vec3(-10), vec3(10), 0.01f, 0.9f, {0, 1, 2, 3});
    const FlatScene scene = city.load();
    RenderSettings settings = steps(10);
    settings.lightCap = 2;  // windows 0 (black) and 2
    const RayResult result = March(scene, 1, settings).trace(through({-20, 0, 0}, {0, 0, 0}));
    EXPECT_EQ(result.glow.x, 0);
    EXPECT_GT(result.glow.y, 0);
    EXPECT_EQ(result.glow.z, 0);
    EXPECT_EQ(result.lightEvaluations, 20u);
}

TEST(MarchReference, FrameHoldsBeautyAsSurfacePlusGlow) {
    SceneBuilder city = paperCity(1);
    const FlatScene scene = city.load();
    RenderProduct product;
    product.camera = "street";
    product.width = 48;
    product.height = 27;
    RenderSettings settings = steps(5);
    settings.pixelSamples = 4;
    const Frame frame = renderReference(scene, product, settings, {}).frame;
    int hazy = 0, sky = 0;
    for (std::size_t i = 0; i < frame.beauty.size(); ++i) {
        const vec3 sum = frame.surface[i] + frame.glow[i];
        EXPECT_LE(glm::length(vec3(frame.beauty[i]) - sum), 1e-6f * (1 + glm::length(sum)));
        hazy += frame.mediaId[i] >= 0;
        sky += frame.depth[i] == kSkyDepth;
        EXPECT_EQ(frame.depth[i] == kSkyDepth, frame.normal[i] == vec3(0));
    }
    EXPECT_GT(hazy, 200);
    EXPECT_GT(sky, 50);
    const Frame again = renderReference(scene, product, settings, {}).frame;
    EXPECT_EQ(frame.beauty, again.beauty);
}

TEST(MarchReference, ListedPixelsEqualThoseOfTheWholeFrame) {
    const FlatScene scene = paperCity(1).load();
    RenderProduct product;
    product.camera = "street";
    product.width = 32;
    product.height = 18;
    const Frame whole = renderReference(scene, product, steps(5), {}).frame;
    product.pixels = {{31, 17}, {0, 0}, {16, 12}};
    const Frame listed = renderReference(scene, product, steps(5), {}).frame;
    ASSERT_EQ(listed.width, 3u);
    ASSERT_EQ(listed.height, 1u);
    for (int i = 0; i < 3; ++i) {
        const std::size_t index = product.pixels[i].y * 32 + product.pixels[i].x;
        EXPECT_EQ(listed.beauty[i], whole.beauty[index]);
        EXPECT_EQ(listed.depth[i], whole.depth[index]);
    }
}

TEST(MarchReference, SelectsPixelsThatSeeAMedium) {
    const FlatScene scene = paperCity(1).load();
    RenderProduct product;
    product.camera = "far25";
    product.width = 64;
    product.height = 36;
    const auto pixels = selectPixels(scene, product, 20, 7);
    ASSERT_EQ(pixels.size(), 20u);
    EXPECT_EQ(pixels, selectPixels(scene, product, 20, 7));
    EXPECT_NE(pixels, selectPixels(scene, product, 20, 8));
    const auto all = selectPixels(scene, product, 10000, 7);
    const Frame frame = renderReference(scene, product, steps(1), {}).frame;
    std::size_t hazy = 0;
    for (const float id : frame.mediaId) {
        hazy += id >= 0;
    }
    EXPECT_EQ(all.size(), hazy);
    std::set<std::pair<uint, uint>> distinct;
    for (const glm::uvec2 pixel : all) {
        distinct.emplace(pixel.x, pixel.y);
        EXPECT_LT(frame.transmittance[pixel.y * 64 + pixel.x], 1);
    }
    EXPECT_EQ(distinct.size(), all.size());
}

TEST(MarchReference, ProgressMayStopTheWork) {
    const FlatScene scene = paperCity(1).load();
    RenderProduct product;
    product.camera = "street";
    product.width = 320;
    product.height = 180;
    struct Stop {};
    EXPECT_THROW(renderReference(scene, product, steps(5), [](double) { throw Stop{}; }), Stop);
}

}  // namespace
}  // namespace nightcity
