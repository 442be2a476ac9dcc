// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The exact method against the judge: within its tolerance under every model, near windows,
// along walls, in thin and thick haze and far from the origin; and not by chance.
#include <algorithm>
#include <cmath>
#include <ostream>

#include <gtest/gtest.h>

#include "device_frame.h"
#include "reference/exact_integral.h"
#include "reference/reference_renderer.h"

namespace nightcity {
namespace {

constexpr std::size_t kPixels = 24;

RenderSettings gaussSettings(const Model& model, double tolerance) {
    RenderSettings settings;
    settings.method = Method::gauss;
    settings.model = model;
    settings.tolerance = tolerance;
    return settings;
}

Frame judge(const FlatScene& scene, const RenderProduct& product, const Model& model,
            double tolerance) {
    RenderSettings settings = gaussSettings(model, tolerance);
    settings.method = Method::reference;
    return renderReference(scene, product, settings, {}).frame;
}

// Pixels of a large frame that see haze.
RenderProduct somePixels(const FlatScene& scene, const std::string& camera) {
    RenderProduct product = productOf(camera, 1920, 1061);
    product.pixels = selectPixels(scene, product, kPixels, 3);
    return product;
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

// Errors at 0.01, and at a tenth of that, of one scene.
void expectWithinTolerance(const FlatScene& scene, const Case& c) {
    const RenderProduct product = somePixels(scene, c.camera);
    const Frame judged = judge(scene, product, c.model, 1e-3);
    for (const double tolerance : {1e-2, 1e-3}) {
        const Frame frame = renderOnDevice(scene, product, gaussSettings(c.model, tolerance));
        const GlowErrors errors = glowErrors(frame, judged);
        EXPECT_LT(errors.p95, tolerance) << tolerance;
        EXPECT_LT(errors.median, 0.4 * tolerance) << tolerance;
    }
}

class GaussAndJudge : public testing::TestWithParam<Case> {};

TEST_P(GaussAndJudge, AgreeOnThePaperCity) {
    expectWithinTolerance(paperCity(2).load(), GetParam());
}

// A device compiles the pass anew for each model: so each choice of a model is met in a few.
INSTANTIATE_TEST_SUITE_P(
    Models, GaussAndJudge,
    testing::Values(Case{"overview75", {Lights::listed, Visibility::none, Emitter::isotropic}},
                    Case{"street", {Lights::listed, Visibility::none, Emitter::isotropic}},
                    Case{"street", {Lights::all, Visibility::none, Emitter::lambertian}},
                    Case{"far25", {Lights::all, Visibility::full, Emitter::isotropic}},
                    Case{"street", {Lights::all, Visibility::full, Emitter::isotropic}},
                    Case{"overview75", {Lights::all, Visibility::full, Emitter::pane}},
                    Case{"street", {Lights::all, Visibility::full, Emitter::pane}}));

// A street of two boxes and a prism whose walls are turned, in haze that is thin above the
// lower roof and thick below it, about `place`.
FlatScene mixedTown(vec3 place, float low = 0.02f, float high = 0.005f) {
    SceneBuilder town;
    const uint wall = town.addMaterial(vec3(0.5f));
    town.ground = GroundPlane{place.z, wall};
    town.addBoxBuilding(place + vec3(-16, -10, 0), place + vec3(-6, 10, 20), wall);
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            const vec3 centre(-5.99f, -7.5f + 5 * float(column), 3 + 4.5f * float(row));
            town.addWindow(place + centre, {0, 0.6f, 0}, {0, 0, 0.75f}, 50);
        }
    }
    town.addBoxBuilding(place + vec3(6, -12, 0), place + vec3(14, 4, 9), wall);
    town.addWindow(place + vec3(5.99f, -6, 4), {0, -0.6f, 0}, {0, 0, 0.75f}, 50);
    town.addWindow(place + vec3(5.99f, 0, 6), {0, -0.6f, 0}, {0, 0, 0.75f}, 80);
    const auto base = uint(town.positions.size());
    for (const vec3 corner : {vec3(0, 7, 0), vec3(5, 6, 0), vec3(3, 11, 0), vec3(2, 8, 14)}) {
        town.positions.push_back(place + corner);
    }
    for (const uvec3 corners : {uvec3(0, 1, 3), uvec3(1, 2, 3), uvec3(2, 0, 3), uvec3(1, 0, 2)}) {
        town.triangles.push_back({corners + base, wall});
    }
    town.buildings.push_back({24, 4, 18, 0, 3});
    std::vector<uint> all(town.windows.size());
    for (uint i = 0; i < all.size(); ++i) {
        all[i] = i;
    }
    town.addMediaBox(place + vec3(-6, -20, 0), place + vec3(6, 20, 9), low, 0.9f, all);
    town.addMediaBox(place + vec3(6, 4, 0), place + vec3(20, 20, 9), low, 0.9f, all);
    town.addMediaBox(place + vec3(-6, -20, 9), place + vec3(20, 20, 24), high, 0.8f, all);
    town.addCamera("above", place + vec3(30, -40, 40), place + vec3(0, 0, 8), 40);
    town.addCamera("street", place + vec3(1, -18, 2), place + vec3(0, 5, 8), 60);
    town.addCamera("grazing", place + vec3(-5.8f, -19, 3.2f), place + vec3(-5.9f, 10, 5), 50);
    return town.load();
}

class GaussInATown : public testing::TestWithParam<Case> {};

TEST_P(GaussInATown, AgreesWithTheJudge) { expectWithinTolerance(mixedTown(vec3(0)), GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Models, GaussInATown,
    testing::Values(Case{"street", {Lights::all, Visibility::full, Emitter::pane}},
                    Case{"above", {Lights::all, Visibility::full, Emitter::pane}},
                    Case{"grazing", {Lights::all, Visibility::full, Emitter::pane}},
                    Case{"grazing", {Lights::listed, Visibility::full, Emitter::lambertian}}));

constexpr Model kSingle{Lights::all, Visibility::full, Emitter::pane};
constexpr Model kPoints{Lights::all, Visibility::full, Emitter::isotropic};

TEST(Gauss, KeepsItsToleranceTenKilometresOut) {
    expectWithinTolerance(mixedTown(vec3(10000.25f, -9000.5f, 12)), {"street", kSingle});
}

// Optical depths of up to 20 and 200.
TEST(Gauss, KeepsItInHazeThatNothingCrosses) {
    expectWithinTolerance(mixedTown(vec3(0), 0.5f, 0.5f), {"street", kSingle});
    expectWithinTolerance(mixedTown(vec3(0), 5, 5),
                          {"grazing", {Lights::listed, Visibility::full, Emitter::lambertian}});
}

// What surfaces send beyond their own dim colour.
TEST(Gauss, LightsSurfacesAsTheJudgeDoes) {
    const FlatScene scene = mixedTown(vec3(0));
    const RenderProduct product = somePixels(scene, "above");
    Model model = kSingle;
    model.surfaces = Surfaces::lit;
    const Frame judged = judge(scene, product, model, 1e-3);
    const Frame frame = renderOnDevice(scene, product, gaussSettings(model, 1e-2));
    std::vector<double> errors;
    for (std::size_t i = 0; i < judged.surface.size(); ++i) {
        const double expected = judged.surface[i].y;
        errors.push_back(std::abs(frame.surface[i].y - expected) / std::max(expected, 1e-6));
    }
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[errors.size() * 95 / 100], 1e-2);
    EXPECT_LT(errors[errors.size() / 2], 4e-3);
}

TEST(Gauss, IsBlackInClearAir) {
    const FlatScene scene = mixedTown(vec3(0), 0, 0);
    const RenderProduct product = somePixels(scene, "street");
    const Frame frame = renderOnDevice(scene, product, gaussSettings(kSingle, 0.01));
    for (const glm::vec3& glow : frame.glow) {
        EXPECT_EQ(glow, glm::vec3(0));
    }
}

// What is wrong by little is seen: the measure and the judge tell these scenes apart.
class GaussMutant : public testing::TestWithParam<const char*> {};

TEST_P(GaussMutant, IsSeen) {
    const std::string mutant = GetParam();
    SceneBuilder city = paperCity(2);
    const FlatScene scene = city.load();
    const RenderProduct product = somePixels(scene, "overview75");
    Model model = kPoints;
    if (mutant == "no visibility") {
        model.visibility = Visibility::none;
    } else if (mutant == "a box less") {
        city.mediaBoxes.erase(city.mediaBoxes.begin() + 7);
    } else if (mutant == "a twentieth of the windows dark") {
        for (std::size_t i = 0; i < city.windows.size(); i += 20) {
            city.windows[i].flags &= ~kWindowOn;
        }
    } else if (mutant == "one per cent more power") {
        for (Window& window : city.windows) {
            window.power *= 1.01f;
        }
    }
    const Frame judged = judge(scene, product, kPoints, 1e-3);
    const Frame frame = renderOnDevice(city.load(), product, gaussSettings(model, 1e-3));
    EXPECT_GT(glowErrors(frame, judged).p95, 5e-3);
}

INSTANTIATE_TEST_SUITE_P(All, GaussMutant,
                         testing::Values("no visibility", "a box less",
                                         "a twentieth of the windows dark",
                                         "one per cent more power"));

}  // namespace
}  // namespace nightcity
