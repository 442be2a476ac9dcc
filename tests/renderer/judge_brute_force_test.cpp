// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The judge against plain marching in a city of mixed heights, two hazes and
// houses that are no boxes.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "brute_force.h"
#include "judge_setup.h"

namespace nightcity {
namespace {

// A house with a ridge roof, turned by `angle` about its middle.
void addHouse(SceneBuilder& city, glm::dvec2 middle, double angle, double half, double eaves,
              double ridge, uint material) {
    const uint base = uint(city.positions.size());
    const auto place = [&](double x, double y, double z) {
        const double c = std::cos(angle), s = std::sin(angle);
        city.positions.emplace_back(middle.x + c * x - s * y, middle.y + s * x + c * y, z);
    };
    for (const double z : {0.0, eaves}) {
        place(-half, -half, z), place(half, -half, z), place(half, half, z), place(-half, half, z);
    }
    place(-half, 0, ridge), place(half, 0, ridge);
    city.buildings.push_back({uint(city.triangles.size()), 14, uint(city.windows.size()), 0,
                              int(city.buildings.size())});
    constexpr uint kCorner[14][3] = {{0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6},
                                     {3, 0, 4}, {3, 4, 7}, {4, 5, 9}, {4, 9, 8}, {6, 7, 8}, {6, 8, 9},
                                     {5, 6, 9}, {7, 4, 8}};
    for (const auto& c : kCorner) {
        city.triangles.push_back({uvec3(base + c[0], base + c[1], base + c[2]), material});
    }
}

SceneBuilder mixedCity() {
    SceneBuilder city;
    const uint wall = city.addMaterial({0.5f, 0.4f, 0.3f});
    city.ground = GroundPlane{0, wall};
    city.addBoxBuilding({-14, -5, 0}, {-6, 5, 22}, wall);
    city.addWindow({-5.99f, 1, 6}, {0, 0.6f, 0}, {0, 0, 0.75f}, 50, {1, 0.5f, 0.2f});
    city.addWindow({-5.99f, -2, 15}, {0, 0.6f, 0}, {0, 0, 0.75f}, 50, {0.2f, 0.5f, 1});
    city.addWindow({-10, -5.01f, 9}, {0.6f, 0, 0}, {0, 0, 0.75f}, 80);
    addHouse(city, {4, 2}, 0.4, 3, 6, 9, wall);
    city.addBoxBuilding({2, -14, 0}, {12, -7, 12}, wall);
    city.addWindow({6, -6.99f, 8}, {-0.6f, 0, 0}, {0, 0, 0.75f}, 60);
    city.addMediaBox({-20, -20, 0}, {1, 20, 22}, 0.03f, 0.9f);
    city.addMediaBox({1, -20, 0}, {20, 20, 12}, 0.05f, 0.7f);
    city.addMediaBox({1, -20, 12}, {20, 20, 16}, 0.02f, 0.8f);
    return city;
}

const std::vector<Ray>& rays() {
    static const std::vector<Ray> kRays{
        through({-3, -19, 2}, {-2, 20, 9}),      // along a street
        through({40, -30, 40}, {-4, 10, 3}),     // from above
        through({-30, 11, 18}, {30, 8, 5}),      // behind the houses
        through({19, 19, 14}, {-5.5, -8, 1}),    // through all three hazes
        through({1, -30, 10}, {1.001, 30, 10}),  // along the face between two hazes
    };
    return kRays;
}

double relativeError(glm::dvec3 value, glm::dvec3 truth) {
    return glm::length(value - truth) / glm::length(truth);
}

class JudgeBruteForce : public testing::TestWithParam<Emitter> {};

TEST_P(JudgeBruteForce, MarchingComesNearerAsItsStepsGrow) {
    const FlatScene scene = mixedCity().load();
    const RenderSettings settings = exactModel(GetParam());
    const ExactIntegral exact(scene, 1, settings, {1e-7, 1e-9});
    const BruteForce march(scene, settings.model);
    const bool pane = GetParam() == Emitter::pane;
    double coarse = 0, fine = 0;
    for (const Ray& ray : rays()) {
        const glm::dvec3 truth = exact.trace(ray).glow;
        const double end = std::min(100.0, march.firstSurface(ray.origin, ray.direction));
        coarse += relativeError(march.glow(ray.origin, ray.direction, end, 400, pane ? 2 : 1), truth);
        const double error = relativeError(
            march.glow(ray.origin, ray.direction, end, pane ? 3200 : 25600, pane ? 6 : 1), truth);
        EXPECT_LT(error, pane ? 1e-3 : 2e-4) << "ray from " << ray.origin.x << " " << ray.origin.y;
        fine += error;
    }
    EXPECT_LT(fine, coarse / 5);
}

INSTANTIATE_TEST_SUITE_P(Emitters, JudgeBruteForce,
                         testing::Values(Emitter::isotropic, Emitter::lambertian, Emitter::pane));

// Many rays at few steps: the mean over rays has no edge error left to speak of, so
// that a wrong shadow or a lost window shows.
TEST(JudgeBruteForceMean, RandomRaysAgree) {
    const FlatScene scene = mixedCity().load();
    const RenderSettings settings = exactModel(Emitter::lambertian);
    const ExactIntegral exact(scene, 1, settings, {1e-5, 1e-6});
    const BruteForce march(scene, settings.model);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    double sum = 0, marched = 0, worst = 0;
    for (int i = 0; i < 150; ++i) {
        const Ray ray = through({40 * unit(random) - 20, -25, 30 * unit(random)},
                                {40 * unit(random) - 20, 25, 25 * unit(random)});
        const double truth = exact.trace(ray).glow.x;
        const double end = std::min(90.0, march.firstSurface(ray.origin, ray.direction));
        const double value = march.glow(ray.origin, ray.direction, end, 2000, 1).x;
        sum += truth;
        marched += value;
        worst = std::max(worst, std::abs(value - truth));
    }
    EXPECT_NEAR(marched / sum, 1, 3e-4);
    EXPECT_LT(worst, 0.02 * sum / 150);
}

TEST_P(JudgeBruteForce, SurfaceLightAgrees) {
    const FlatScene scene = mixedCity().load();
    RenderSettings settings = exactModel(GetParam());
    const LightScene lights(scene, 1, settings);
    const SurfaceLight judge(lights, {1e-8, 1e-9});
    const BruteForce march(scene, settings.model);
    const bool pane = GetParam() == Emitter::pane;
    const SurfacePoint points[] = {{{-2, 0, 0}, {0, 0, 1}, std::nullopt},
                                   {{0.5, -3, 0}, {0, 0, 1}, std::nullopt},
                                   {{-6, -6, 0}, {0, 0, 1}, std::nullopt},
                                   {{2, -10, 5}, {-1, 0, 0}, std::nullopt},
                                   {{5, -7, 4}, {0, 1, 0}, std::nullopt},
                                   {{15, 12, 0}, {0, 0, 1}, std::nullopt}};
    int lit = 0;
    for (const SurfacePoint& point : points) {
        const glm::dvec3 truth = judge.irradiance(point).value;
        const glm::dvec3 value = march.irradiance(point.place, point.normal, 200);
        lit += truth.x > 0;
        EXPECT_LE(glm::length(value - truth), (pane ? 2e-3 : 1e-9) * glm::length(truth))
            << point.place.x << " " << point.place.y;
    }
    EXPECT_GE(lit, 3);
}

}  // namespace
}  // namespace nightcity
