// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What hides a window and what does not: its own wall, walls that touch it; windows
// together against windows one by one.
#include <gtest/gtest.h>

#include "judge_setup.h"

namespace nightcity {
namespace {

constexpr Emitter kEmitters[] = {Emitter::isotropic, Emitter::lambertian, Emitter::pane};

// A house whose wall is `gap` metres behind its window (in front where negative).
SceneBuilder houseAndWindow(float gap) {
    SceneBuilder city;
    city.addBoxBuilding({-5, -10, 0}, {5, 0, 10}, city.addMaterial(vec3(0.5f)));
    city.addWindow({0, gap, 4}, {-0.5f, 0, 0}, {0, 0, 0.75f}, 50);
    city.addMediaBox({-30, 0, 0}, {30, 30, 12}, 0.02f, 0.9f);
    return city;
}

TEST(JudgeSight, OwnWallWithinFiveCentimetresHidesNothing) {
    const Ray ray = through({-20, 8, 3}, {20, 6, 5});
    for (const Emitter emitter : kEmitters) {
        const auto lit = [&](float gap) {
            return glow(houseAndWindow(gap).load(), exactModel(emitter), ray, {1e-6, 1e-8});
        };
        const double inFront = lit(0.01f);
        ASSERT_GT(inFront, 0);
        EXPECT_NEAR(lit(0) / inFront, 1, 0.01);
        EXPECT_NEAR(lit(-0.04f) / inFront, 1, 0.03);
        EXPECT_EQ(lit(-0.06f), 0);
    }
}

// In air that dims nothing: 1 / d^2 along the chord of the sphere of that radius.
TEST(JudgeSight, ReachEndsTheLightOfAWindow) {
    SceneBuilder city;
    addFreeWindow(city, {0, 0, 4});
    city.addMediaBox({-100, -100, 0}, {100, 100, 12}, 1e-14f, 0.9f);
    const FlatScene scene = city.load();
    const Ray ray = through({-90, 3, 4}, {90, 3, 4});
    RenderSettings settings = exactModel(Emitter::isotropic);
    for (const double reach : {3.5, 20.0, 60.0}) {
        settings.reach = reach;
        const double chord = 2 * std::atan(std::sqrt(reach * reach - 9) / 3);
        const double expected = phaseScattering(city) * 50 / (4 * kPi * 3) * chord;
        EXPECT_NEAR(glow(scene, settings, ray) / expected, 1, 1e-6) << reach;
    }
    settings.reach = 2.9;
    EXPECT_EQ(glow(scene, settings, ray), 0);
}

TEST(JudgeSight, ReachEndsTheLightOnSurfaces) {
    const FlatScene scene = houseAndWindow(0.01f).load();
    const auto lit = [&](double reach) {
        RenderSettings settings = exactModel(Emitter::pane);
        settings.reach = reach;
        const LightScene lights(scene, 1, settings);
        const SurfacePoint point{{1, 6, 3}, {0, -1, 0}, std::nullopt};
        return SurfaceLight(lights, {1e-6, 1e-8}).irradiance(point).value.x;
    };
    EXPECT_GT(lit(6.2), 0);  // the window is 6.16 m away
    EXPECT_EQ(lit(6.1), 0);
}

// The same rule for light on surfaces.
TEST(JudgeSight, OwnWallHidesNothingFromSurfaces) {
    for (const Emitter emitter : kEmitters) {
        const auto lit = [&](float gap) {
            const FlatScene scene = houseAndWindow(gap).load();
            const LightScene lights(scene, 1, exactModel(emitter));
            const SurfacePoint point{{1, 6, 3}, {0, -1, 0}, std::nullopt};
            return SurfaceLight(lights, {1e-6, 1e-8}).irradiance(point).value.x;
        };
        ASSERT_GT(lit(0.01f), 0);
        EXPECT_NEAR(lit(-0.02f) / lit(0.01f), 1, 0.02);
        EXPECT_EQ(lit(-0.06f), 0);
    }
}

// A wall that stands on the middle of the pane: either side sees its half.
TEST(JudgeSight, WallThatTouchesThePaneHidesHalfOfIt) {
    SceneBuilder city;
    addFreeWindow(city, {0, 0, 4});
    city.addMediaBox({-30, -30, 0}, {30, 30, 12}, 1e-14f, 0.9f);
    SceneBuilder half;
    addFreeWindow(half, {-0.25f, 0, 4}, 1, 0.25f, 0.75f, 25);
    half.mediaBoxes = city.mediaBoxes;
    city.addBoxBuilding({0, 0, -20}, {0.5f, 40, 40}, city.addMaterial(vec3(0.5f)));
    const Ray left = through({-2, 3, 2}, {-6, 9, 7});
    EXPECT_NEAR(glow(city.load(), exactModel(Emitter::pane), left, {1e-8, 1e-10}) /
                    glow(half.load(), exactModel(Emitter::pane), left, {1e-8, 1e-10}),
                1, 1e-7);
    const Ray right = through({2, 3, 2}, {6, 9, 7});  // the wall is 0.5 m thick: nothing
    EXPECT_LT(glow(city.load(), exactModel(Emitter::pane), right, {1e-8, 1e-10}), 1e-25);
}

TEST(JudgeSight, RaysThroughThePaneAndFromItsWallAreFinite) {
    const FlatScene scene = houseAndWindow(0.01f).load();
    const RenderSettings settings = exactModel(Emitter::pane);
    const auto value = [&](const Ray& ray) { return glow(scene, settings, ray, {1e-5, 1e-8}); };
    const double through0 = value(through({0.1, 20, 4.2}, {0.1, 0, 4.2}));
    EXPECT_GT(through0, 0);
    EXPECT_NEAR(value(through({0.1001, 20, 4.2}, {0.1001, 0, 4.2})) / through0, 1, 1e-3);
    // Along a line through a corner of the pane; from the wall; along the wall.
    for (const Ray& ray : {through({0.5, 20, 4.75}, {0.5, 0, 4.75}), through({2, 0, 3}, {2, 10, 5}),
                           through({-20, 0.005, 4}, {20, 0.005, 4}),
                           through({-20, 0.01, 4}, {20, 0.01, 4})}) {
        const double found = value(ray);
        EXPECT_TRUE(std::isfinite(found));
        EXPECT_GE(found, 0);
    }
}

// Neighbours share what may hide them: it must be what hides each alone.
TEST(JudgeSight, WindowsTogetherAreTheSumOfEachAlone) {
    const SceneBuilder city = paperCity(2);
    const Ray rays[] = {through({30, -50, 30}, {1, -4, 2}), through({1.5, -24, 2}, {0, 10, 9}),
                        through({-30, 2, 40}, {3, 4, 0})};
    for (const Emitter emitter : kEmitters) {
        const Accuracy accuracy{1e-6, 1e-9};
        const FlatScene scene = city.load();
        for (const Ray& ray : rays) {
            const auto segments = MediaSegments(scene).along(
                ray, OpaqueSurfaces(scene, 1).nearest(ray).distance);
            const LightScene together(scene, 1, exactModel(emitter));
            const double sum = SingleScattering(together, accuracy).along(ray, segments).value.x;
            double each = 0;
            for (const LitWindow& window : together.windows) {
                LightScene alone = together;
                alone.windows = {window};
                alone.groups = WindowGroups(alone.windows, emitter);
                each += SingleScattering(alone, accuracy).along(ray, segments).value.x;
            }
            ASSERT_GT(sum, 0);
            EXPECT_NEAR(each / sum, 1, 2e-6) << int(emitter);
        }
    }
}

}  // namespace
}  // namespace nightcity
