// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The path tracer against the judge (design section 5).
#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>

#include <gtest/gtest.h>

#include "device_frame.h"
#include "reference/adaptive_quadrature.h"
#include "reference/ray.h"
#include "reference/reference_renderer.h"

namespace nightcity {
namespace {

// Of pixels whose judged glow is not 0; green, for channels of one window rise and fall together.
struct Agreement {
    std::size_t pixels = 0;
    double bias = 0;           // of the mean, in its standard errors
    double standardError = 0;  // of the mean, relative
    double worst = 0;          // z of a pixel
};

Agreement agreement(const Frame& frame, const Frame& judged) {
    double sum = 0, expected = 0, variance = 0;
    Agreement result;
    for (std::size_t i = 0; i < judged.glow.size(); ++i) {
        const double found = frame.glow[i].y, truth = judged.glow[i].y;
        const double error = frame.glowError[i].y;
        if (truth == 0) {
            EXPECT_EQ(found, 0);
            continue;
        }
        ++result.pixels;
        sum += found;
        expected += truth;
        variance += error * error;
        result.worst = std::max(result.worst, std::abs(found - truth) / error);
    }
    result.bias = (sum - expected) / std::sqrt(variance);
    result.standardError = std::sqrt(variance) / expected;
    return result;
}

// Sidak: |z| that the largest of n independent normal numbers passes with probability 1 %.
double largestZ(std::size_t n) {
    const double each = 1 - std::pow(0.99, 1 / double(n));
    double low = 0, high = 10;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (std::erfc(middle / std::sqrt(2)) > each ? low : high) = middle;
    }
    return high;
}

RenderSettings pathSettings(const Model& model, std::uint32_t samples) {
    RenderSettings settings;
    settings.method = Method::path;
    settings.model = model;
    settings.samples = samples;
    settings.seed = 11;
    return settings;
}

Frame judge(const FlatScene& scene, const RenderProduct& product, const Model& model) {
    RenderSettings settings;
    settings.method = Method::reference;
    settings.model = model;
    settings.tolerance = 0.001;
    return renderReference(scene, product, settings, {}).frame;
}

struct Case {
    const char* camera;
    Model model;
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.camera << (c.model.lights == Lights::all ? " all" : " listed")
         << (c.model.visibility == Visibility::full ? " full" : " none")
         << (c.model.emitter == Emitter::isotropic    ? " isotropic"
             : c.model.emitter == Emitter::lambertian ? " lambertian"
                                                      : " pane");
}

class PathAndJudge : public testing::TestWithParam<Case> {};

TEST_P(PathAndJudge, AgreeOnThePaperCity) {
    const FlatScene scene = paperCity(2).load();
    RenderProduct product = productOf(GetParam().camera, 1920, 1061);
    product.pixels = selectPixels(scene, product, 32, 3);
    const Frame frame = renderOnDevice(scene, product, pathSettings(GetParam().model, 24576));
    const Agreement found = agreement(frame, judge(scene, product, GetParam().model));
    EXPECT_GT(found.pixels, 20u);
    EXPECT_LT(std::abs(found.bias), 3);
    EXPECT_LT(found.worst, largestZ(found.pixels));
    EXPECT_LT(found.standardError, 0.005);
}

INSTANTIATE_TEST_SUITE_P(
    Models, PathAndJudge,
    testing::Values(
        Case{"overview75", {Lights::all, Visibility::full, Emitter::pane}},
        Case{"street", {Lights::all, Visibility::full, Emitter::lambertian}},
        Case{"overview75", {Lights::all, Visibility::full, Emitter::isotropic}},
        Case{"street", {Lights::all, Visibility::none, Emitter::pane}},
        Case{"street", {Lights::all, Visibility::none, Emitter::lambertian}},
        Case{"overview75", {Lights::all, Visibility::none, Emitter::isotropic}},
        Case{"street", {Lights::listed, Visibility::full, Emitter::pane}},
        Case{"overview75", {Lights::listed, Visibility::none, Emitter::isotropic}}));

constexpr Model kSingle{Lights::all, Visibility::full, Emitter::pane};

Model multiple(Surfaces surfaces = Surfaces::dim) {
    Model model = kSingle;
    model.scattering = Scattering::multiple;
    model.surfaces = surfaces;
    return model;
}

double sum(const std::vector<glm::vec3>& values) {
    double total = 0;
    for (const glm::vec3& value : values) {
        total += value.y;
    }
    return total;
}

double errorOfSum(const Frame& frame) {
    double variance = 0;
    for (const glm::vec3& error : frame.glowError) {
        variance += double(error.y) * error.y;
    }
    return std::sqrt(variance);
}

class PaperPaths : public testing::Test {
protected:
    PaperPaths() {
        product_.pixels = selectPixels(scene_, product_, 64, 5);
    }

    Frame render(const Model& model, std::uint32_t samples, Orders orders = {},
                 std::uint64_t seed = 1, float g = 0) {
        RenderSettings settings = pathSettings(model, samples);
        settings.orders = orders;
        settings.seed = seed;
        settings.anisotropy = g;
        return renderOnDevice(scene_, product_, settings);
    }

    FlatScene scene_ = paperCity(1).load();
    RenderProduct product_ = productOf("overview75", 640, 360);
};

TEST_F(PaperPaths, OrdersAddUp) {
    for (const Surfaces surfaces : {Surfaces::dim, Surfaces::lit}) {
        const Frame all = render(multiple(surfaces), 1024, {}, 1);
        const Frame first = render(multiple(surfaces), 1024, {1, 1}, 2);
        const Frame rest = render(multiple(surfaces), 1024, {2, std::nullopt}, 3);
        const double noise = std::hypot(errorOfSum(all), errorOfSum(first), errorOfSum(rest));
        EXPECT_LT(std::abs(sum(first.glow) + sum(rest.glow) - sum(all.glow)), 3 * noise);
        EXPECT_GT(sum(rest.glow), 10 * errorOfSum(rest));
    }
}

TEST_F(PaperPaths, SameSeedSameBytesWhateverThePixelList) {
    const Frame once = render(multiple(Surfaces::lit), 40);
    const Frame again = render(multiple(Surfaces::lit), 40);
    EXPECT_EQ(once.glow, again.glow);
    EXPECT_EQ(once.glowError, again.glowError);
    EXPECT_EQ(once.surface, again.surface);
    EXPECT_NE(once.glow, render(multiple(Surfaces::lit), 40, {}, 2).glow);
    std::reverse(product_.pixels.begin(), product_.pixels.end());
    const Frame turned = render(multiple(Surfaces::lit), 40);
    for (std::size_t i = 0; i < once.glow.size(); ++i) {
        EXPECT_EQ(once.glow[i], turned.glow[once.glow.size() - 1 - i]);
    }
}

// Over seeds, (mean - truth) / error is a normal number: the mean of its square is 1.
TEST_F(PaperPaths, StandardErrorIsHonest) {
    const Frame judged = judge(scene_, product_, kSingle);
    double squares = 0, count = 0;
    for (std::uint64_t seed = 1; seed <= 24; ++seed) {
        const Frame frame = render(kSingle, 512, {}, seed);
        for (std::size_t i = 0; i < judged.glow.size(); ++i) {
            if (judged.glow[i].y > 0) {
                const double z = (frame.glow[i].y - judged.glow[i].y) / frame.glowError[i].y;
                squares += z * z;
                ++count;
            }
        }
    }
    EXPECT_NEAR(squares / count, 1, 0.2);
}

// What walls and ground reflect has no error channel: its error is the spread over seeds.
TEST_F(PaperPaths, LitSurfacesAgreeWithTheJudge) {
    constexpr int kSeeds = 16;
    constexpr float kPane = 1;  // W m^-2 sr^-1: no surface reflects as much
    Model lit = kSingle;
    lit.surfaces = Surfaces::lit;
    product_ = productOf("street", 640, 360);
    product_.pixels = selectPixels(scene_, product_, 16, 5);
    const Frame judged = judge(scene_, product_, lit);
    double truth = 0;
    for (const glm::vec3& surface : judged.surface) {
        truth += surface.y < kPane ? surface.y : 0;
    }
    double mean = 0, squares = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const Frame frame = render(lit, 384, {}, seed);
        double share = 0;
        for (std::size_t i = 0; i < judged.surface.size(); ++i) {
            share += judged.surface[i].y < kPane ? frame.surface[i].y / truth : 0;
        }
        mean += share / kSeeds;
        squares += share * share / kSeeds;
    }
    const double error = std::sqrt((squares - mean * mean) / (kSeeds - 1));
    EXPECT_GT(truth, 0);
    EXPECT_LT(std::abs(mean - 1), 3 * error);
    EXPECT_LT(error, 0.005);
    EXPECT_GT(error, 0);
}

// Every box of another haze: thick and thin, bright and dark, in turn.
TEST_F(PaperPaths, AgreeWithTheJudgeInMixedHazes) {
    SceneBuilder city = paperCity(1);
    for (std::size_t i = 0; i < city.mediaBoxes.size(); ++i) {
        city.mediaBoxes[i].extinction = i % 2 == 0 ? 0.03f : 0.004f;
        city.mediaBoxes[i].albedo = i % 3 == 0 ? 0.5f : 0.95f;
    }
    scene_ = city.load();
    const Agreement found = agreement(render(kSingle, 6144), judge(scene_, product_, kSingle));
    EXPECT_GT(found.pixels, 40u);
    EXPECT_LT(std::abs(found.bias), 3);
    EXPECT_LT(found.worst, largestZ(found.pixels));
    EXPECT_LT(found.standardError, 0.005);
}

// Henyey and Greenstein 1941: the share of light that turns by an angle, per steradian.
double phase(double g, double cosine) {
    const double distance = 1 + g * g - 2 * g * cosine;
    return (1 - g * g) / (4 * std::numbers::pi * distance * std::sqrt(distance));
}

// Single scattering of one isotropic point in one box is an integral along the ray.
TEST(PathPhase, OneLightIsTheIntegralOfItsPhase) {
    constexpr double kExtinction = 0.02, kAlbedo = 0.9, kPower = 50;
    const glm::dvec3 light(0, 0, 10);
    SceneBuilder city;
    city.addWindow(vec3(light), {0.5f, 0, 0}, {0, 0, 0.5f}, float(kPower), vec3(1), false);
    city.addMediaBox({-40, -40, 0}, {40, 40, 40}, float(kExtinction), float(kAlbedo));
    city.addCamera("inside", {-20, -25, 12}, {0, 0, 10}, 50);
    const FlatScene scene = city.load();
    RenderProduct product = productOf("inside", 6, 5);
    for (const float g : {0.7f, -0.5f}) {
        RenderSettings settings =
            pathSettings({Lights::all, Visibility::none, Emitter::isotropic}, 16384);
        settings.anisotropy = g;
        const Frame frame = renderOnDevice(scene, product, settings);
        Frame truth = frame;
        for (glm::uint i = 0; i < 30; ++i) {
            const Ray ray = cameraRay(scene.camera("inside").at(1), glm::vec3(0),
                                      {i % 6 + 0.5, i / 6 + 0.5}, {6, 5});
            const auto scattered = [&](double t) {
                const glm::dvec3 way = ray.at(t) - light;
                const double distance = glm::length(way);
                return phase(g, glm::dot(way, -ray.direction) / distance) * kExtinction * kAlbedo *
                       kPower / (4 * std::numbers::pi * distance * distance) *
                       std::exp(-kExtinction * (t + distance));
            };
            // To the wall of the box that the ray leaves through.
            double end = 1e9;
            for (int axis = 0; axis < 3; ++axis) {
                const double wall = ray.direction[axis] > 0 ? 40 : axis == 2 ? 0 : -40;
                end = std::min(end, (wall - ray.origin[axis]) / ray.direction[axis]);
            }
            const double nearest = glm::dot(light - ray.origin, ray.direction);
            const std::vector<double> pieces{0, std::clamp(nearest, 0.0, end), end};
            truth.glow[i] = glm::vec3(float(
                integrate(scattered, pieces, {0, 1e-10}).value));
        }
        const Agreement found = agreement(frame, truth);
        EXPECT_EQ(found.pixels, 30u);
        EXPECT_LT(std::abs(found.bias), 3) << "g " << g;
        EXPECT_LT(found.worst, largestZ(found.pixels)) << "g " << g;
        EXPECT_LT(found.standardError, 0.005) << "g " << g;
    }
}

// A house whose wall is `gap` metres behind its window (in front where negative).
SceneBuilder houseAndWindow(float gap) {
    SceneBuilder city;
    city.addBoxBuilding({-5, -10, 0}, {5, 0, 10}, city.addMaterial(vec3(0.5f)));
    city.addWindow({0, gap, 4}, {-0.5f, 0, 0}, {0, 0, 0.75f}, 50);
    city.addMediaBox({-30, 0, 0}, {30, 30, 12}, 0.02f, 0.9f);
    city.addCamera("along", {-28, 9, 3}, {20, 5, 5}, 30);
    return city;
}

TEST(PathSight, OwnWallWithinFiveCentimetresHidesNothing) {
    RenderProduct product = productOf("along", 6, 4);
    for (const Emitter emitter : {Emitter::isotropic, Emitter::pane}) {
        const Model model{Lights::all, Visibility::full, emitter};
        for (const float gap : {0.0f, -0.04f, -0.06f}) {
            const FlatScene scene = houseAndWindow(gap).load();
            const Frame frame = renderOnDevice(scene, product, pathSettings(model, 1024));
            if (gap < -0.05f) {
                EXPECT_EQ(sum(frame.glow), 0) << gap;
                continue;
            }
            const Agreement found = agreement(frame, judge(scene, product, model));
            EXPECT_EQ(found.pixels, 24u) << gap;
            EXPECT_LT(std::abs(found.bias), 3) << gap;
            EXPECT_LT(found.worst, largestZ(found.pixels)) << gap;
        }
    }
}

// 2 cm beside one of 401 windows: few paths would meet that one if it were chosen as the others.
TEST(PathLights, WindowBesideTheRayIsNotMissed) {
    SceneBuilder city;
    for (int i = 0; i < 400; ++i) {
        city.addWindow({float(i % 20) * 3 - 30, 40, float(i / 20) * 2 + 1}, {-0.5f, 0, 0},
                       {0, 0, 0.5f}, 50, vec3(1), false);
    }
    city.addWindow({0, 0, 20.02f}, {-0.5f, 0, 0}, {0, 0, 0.5f}, 50, vec3(1), false);
    city.addMediaBox({-60, -60, 0}, {60, 60, 50}, 0.01f, 0.9f);
    city.addCamera("beside", {-40, -1, 20}, {40, 1, 20}, 0.01);
    const FlatScene scene = city.load();
    const RenderProduct product = productOf("beside", 4, 4);
    const Model model{Lights::all, Visibility::full, Emitter::isotropic};
    const Frame frame = renderOnDevice(scene, product, pathSettings(model, 4096));
    const Agreement found = agreement(frame, judge(scene, product, model));
    EXPECT_EQ(found.pixels, 16u);
    EXPECT_LT(std::abs(found.bias), 3);
    EXPECT_LT(found.worst, largestZ(found.pixels));
    EXPECT_LT(found.standardError, 0.01);
}

TEST_F(PaperPaths, AlbedoZeroScattersNothing) {
    scene_ = paperCity(1, 0.01f, 0).load();
    EXPECT_EQ(sum(render(multiple(), 32).glow), 0);
}

}  // namespace
}  // namespace nightcity
