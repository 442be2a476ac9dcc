// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The march on the device against the same march in double precision on the
// CPU, which shares no formula with it, and against closed forms.
#include <cmath>
#include <numbers>
#include <ostream>

#include <gtest/gtest.h>

#include "device_frame.h"
#include "reference/reference_renderer.h"

namespace nightcity {
namespace {

// The project's bars are 1e-5 and 1e-3. Float leaves 2e-7 at most pixels and 1e-5 beside a
// window; ten times less than the bars is held here, so that a lost digit shows.
constexpr double kMedian = 1e-6;
constexpr double kWorst = 1e-4;

struct Variant {
    const char* camera;
    MarchOrder order;
    LightStorage storage;
};

void PrintTo(const Variant& variant, std::ostream* out) {
    *out << variant.camera << (variant.order == MarchOrder::lights ? " lights" : " steps")
         << (variant.storage == LightStorage::uniform ? " uniform" : " storage");
}

class PaperCityMarch : public testing::TestWithParam<Variant> {};

TEST_P(PaperCityMarch, AgreesWithDoublePrecision) {
    const FlatScene scene = paperCity(4).load();
    RenderSettings settings;
    settings.marchOrder = GetParam().order;
    settings.lightStorage = GetParam().storage;
    RenderProduct product = productOf(GetParam().camera, 1920, 1061);
    product.pixels = selectPixels(scene, product, 2000, 1);
    ASSERT_EQ(product.pixels.size(), 2000u);
    RenderStatistics statistics;
    const Frame frame = renderOnDevice(scene, product, settings, &statistics);
    const ReferenceImage reference = renderReference(scene, product, settings, {});
    const GlowErrors errors = glowErrors(frame, reference.frame);
    EXPECT_LT(errors.median, kMedian);
    EXPECT_LT(errors.worst, kWorst);
    EXPECT_LT(std::abs(errors.bias), kMedian);
    EXPECT_EQ(statistics.lightEvaluations, reference.statistics.lightEvaluations);
    for (std::size_t i = 0; i < product.pixels.size(); ++i) {
        EXPECT_NEAR(frame.transmittance[i], reference.frame.transmittance[i], 1e-6);
        EXPECT_EQ(frame.mediaId[i], reference.frame.mediaId[i]);
        EXPECT_EQ(frame.materialId[i], reference.frame.materialId[i]);
        EXPECT_NEAR(frame.depth[i] / reference.frame.depth[i], 1, 1e-5);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Cameras, PaperCityMarch,
    testing::Values(Variant{"overview75", MarchOrder::lights, LightStorage::uniform},
                    Variant{"street", MarchOrder::lights, LightStorage::storage},
                    Variant{"far25", MarchOrder::lights, LightStorage::uniform},
                    Variant{"overview75", MarchOrder::steps, LightStorage::storage},
                    Variant{"street", MarchOrder::steps, LightStorage::uniform},
                    Variant{"far25", MarchOrder::steps, LightStorage::storage}));

// A lone light beside a long box that is seen from its end.
SceneBuilder oneLight(float extinction) {
    SceneBuilder city;
    city.addWindow({2, 0, 3}, {0.5f, 0, 0}, {0, 0, 0.5f}, 50, {1, 0.5f, 0.25f}, false);
    city.windows[0].flags |= kWindowSphere;  // lights the haze, is not seen
    city.addMediaBox({-10, -10, -10}, {10, 10, 10}, extinction, 0.9f, {0});
    city.addCamera("end", {-30, 1.5f, 3}, {0, 1.5f, 3}, 1);
    return city;
}

TEST(March, OneLightInThinHazeFollowsTheClosedForm) {
    constexpr double kPi = std::numbers::pi;
    const FlatScene scene = oneLight(1e-9f).load();
    RenderSettings settings;
    settings.subdivisions = 2000;
    const Frame frame = renderOnDevice(scene, productOf("end", 1, 1), settings);
    // The integral of 1 / d^2 along a line at distance h is the angle seen from the light / h.
    const double h = 1.5;
    const double expected = 1e-9 * 0.9 / (4 * kPi) * 50 / (4 * kPi) *
                            (std::atan(8 / h) - std::atan(-12 / h)) / h;
    EXPECT_NEAR(frame.glow[0].x / expected, 1, 1e-5);
    EXPECT_NEAR(frame.glow[0].y / frame.glow[0].x, 0.5, 1e-6);
    EXPECT_NEAR(frame.glow[0].z / frame.glow[0].x, 0.25, 1e-6);
}

TEST(March, TransmittanceOfOneBoxIsExponential) {
    for (const float extinction : {1e-4f, 0.01f, 0.3f, 6.0f}) {
        const FlatScene scene = oneLight(extinction).load();
        const Frame frame = renderOnDevice(scene, productOf("end", 1, 1), {});
        const double expected = std::exp(-20.0 * double(extinction));
        EXPECT_NEAR(frame.transmittance[0], expected, 1e-6 * expected + 1e-30);
        EXPECT_FLOAT_EQ(frame.beauty[0].a, 1 - frame.transmittance[0]);
    }
}

TEST(March, AnyNumberOfStepsIsTaken) {  // the loop is unrolled by five
    const FlatScene scene = oneLight(0.05f).load();
    const RenderProduct product = productOf("end", 1, 1);
    for (const std::uint32_t steps : {1u, 2u, 4u, 5u, 6u, 9u, 100u}) {
        RenderSettings settings;
        settings.subdivisions = steps;
        const double expected = renderReference(scene, product, settings, {}).frame.glow[0].x;
        RenderStatistics statistics;
        const Frame frame = renderOnDevice(scene, product, settings, &statistics);
        EXPECT_NEAR(frame.glow[0].x / expected, 1, 2e-6) << steps;
        EXPECT_EQ(statistics.lightEvaluations, steps);
    }
}

TEST(March, MixedExtinctionsAddUpPieceByPiece) {
    SceneBuilder city;
    city.addWindow({15, 4, 3}, {0.5f, 0, 0}, {0, 0, 0.5f}, 50, vec3(1), false);
    for (int i = 0; i < 12; ++i) {  // more than a traversal hands on at once
        city.addMediaBox({3.0f * i, -5, -5}, {3.0f * i + 3, 5, 5}, 0.002f * float(i * i % 7 + 1),
                         0.1f * float(i % 10), {0});
    }
    city.addCamera("along", {-20, 0.3f, 0.2f}, {10, 0.1f, -0.1f}, 8);
    const FlatScene scene = city.load();
    const RenderProduct product = productOf("along", 16, 16);
    const Frame frame = renderOnDevice(scene, product, {});
    const Frame reference = renderReference(scene, product, {}, {}).frame;
    EXPECT_LT(glowErrors(frame, reference).worst, 1e-5);
    for (std::size_t i = 0; i < frame.transmittance.size(); ++i) {
        EXPECT_NEAR(frame.transmittance[i], reference.transmittance[i], 1e-6);
    }
}

}  // namespace
}  // namespace nightcity
