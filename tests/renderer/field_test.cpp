// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Frames of --method field: against the judge, and the same however they are cut.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "device_frame.h"
#include "passes/glow_passes.h"
#include "reference/reference_renderer.h"

namespace nightcity {
namespace {

const Model kSingle{Lights::all, Visibility::full, Emitter::pane, Scattering::single,
                    Surfaces::dim};

RenderSettings fieldSettings(GlowRays rays = GlowRays::sparse) {
    RenderSettings settings;
    settings.method = Method::field;
    settings.model = kSingle;
    settings.tolerance = 0.01;
    settings.glowRays = rays;
    return settings;
}

Frame judged(const FlatScene& scene, const RenderProduct& product, const Model& model = kSingle) {
    RenderSettings settings;
    settings.method = Method::reference;
    settings.model = model;
    settings.tolerance = 0.01;
    return renderReference(scene, product, settings, {}).frame;
}

// Every `step`th pixel of a product, along both sides.
RenderProduct some(RenderProduct product, std::uint32_t step) {
    for (std::uint32_t y = step / 2; y < product.height; y += step) {
        for (std::uint32_t x = step / 2; x < product.width; x += step) {
            product.pixels.emplace_back(x, y);
        }
    }
    return product;
}

// One box building, two lit windows on its front and a room of haze before it.
SceneBuilder twoWindows() {
    SceneBuilder city;
    const uint wall = city.addMaterial(vec3(0.5f));
    city.ground = GroundPlane{0, wall};
    city.addBoxBuilding({-6, 0, 0}, {6, 8, 12}, wall);
    city.addWindow({-2, -0.01f, 6}, {0.6f, 0, 0}, {0, 0, 0.75f}, 50, vec3(1, 0.8f, 0.5f));
    city.addWindow({2, -0.01f, 6}, {0.6f, 0, 0}, {0, 0, 0.75f}, 50, vec3(0.5f, 0.8f, 1));
    city.addMediaBox({-8, -12, 0}, {8, 0, 12}, 0.02f, 0.9f, {0, 1});
    city.addCamera("front", {1, -20, 7}, {0, 0, 6}, 40);
    city.addCamera("inside", {-4, -6, 5}, {2, 0, 6}, 60);
    // 1 cm before the pane, along the facade.
    city.addCamera("atPane", {-2, -0.02f, 6}, {6, -0.5f, 6}, 50);
    return city;
}

void expectSame(const Frame& a, const Frame& b) {
    ASSERT_EQ(a.beauty.size(), b.beauty.size());
    EXPECT_EQ(std::memcmp(a.beauty.data(), b.beauty.data(), a.beauty.size() * sizeof(glm::vec4)), 0);
    EXPECT_EQ(std::memcmp(a.glow.data(), b.glow.data(), a.glow.size() * sizeof(glm::vec3)), 0);
    EXPECT_EQ(a.transmittance, b.transmittance);
    EXPECT_EQ(a.mediaId, b.mediaId);
    EXPECT_EQ(a.depth, b.depth);
}

struct Case {
    const char* camera;
    double median, worst;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.camera; }

class FieldCameras : public testing::TestWithParam<Case> {};

TEST_P(FieldCameras, AgreeWithTheJudge) {
    const FlatScene scene = twoWindows().load();
    const RenderProduct product = some(productOf(GetParam().camera, 120, 80), 24);
    const Frame field = renderOnDevice(scene, product, fieldSettings());
    const Frame judge = judged(scene, product);
    const GlowErrors errors = glowErrors(field, judge);
    EXPECT_LT(errors.median, GetParam().median);
    EXPECT_LT(errors.worst, GetParam().worst);
    for (std::size_t i = 0; i < judge.transmittance.size(); ++i) {
        EXPECT_NEAR(field.transmittance[i], judge.transmittance[i], 1e-3);
    }
}

INSTANTIATE_TEST_SUITE_P(TwoWindows, FieldCameras,
                         testing::Values(Case{"front", 0.005, 0.03}, Case{"inside", 0.01, 0.03},
                                         Case{"atPane", 0.005, 0.03}));

// A window two metres from the corner of a building, one around it, and haze of two kinds.
SceneBuilder corner() {
    SceneBuilder city;
    const uint wall = city.addMaterial(vec3(0.5f));
    city.ground = GroundPlane{0, wall};
    city.addBoxBuilding({-6, 0, 0}, {6, 8, 12}, wall);
    city.addWindow({-2, -0.01f, 6}, {0.6f, 0, 0}, {0, 0, 0.75f}, 50, vec3(1, 0.8f, 0.5f));
    city.addWindow({4, -0.01f, 6}, {0.6f, 0, 0}, {0, 0, 0.75f}, 50, vec3(0.5f, 0.8f, 1));
    city.addWindow({6.01f, 4, 6}, {0, 0.6f, 0}, {0, 0, 0.75f});
    city.addMediaBox({-8, -12, 0}, {14, 0, 12}, 0.02f, 0.9f);
    city.addMediaBox({6, 0, 0}, {14, 8, 12}, 0.04f, 0.8f);
    city.addCamera("corner", {20, -10, 9}, {5, 0, 6}, 50);
    return city;
}

// Haze of two kinds around a building, in boxes that share faces, one of them far thinner than a
// pixel is wide, and a layer above.
SceneBuilder manyBoxes() {
    SceneBuilder city;
    const uint wall = city.addMaterial(vec3(0.5f));
    city.ground = GroundPlane{0, wall};
    city.addBoxBuilding({-4, 0, 0}, {4, 8, 9}, wall);
    city.addWindow({0, -0.01f, 6}, {0.6f, 0, 0}, {0, 0, 0.75f});
    for (int i = 0; i < 6; ++i) {
        const float x = -12.0f + 4.0f * float(i);
        city.addMediaBox({x, -12, 0}, {x + 4, -4, 9}, 0.02f, 0.9f);
        city.addMediaBox({x, -4, 0}, {x + 4, 0, 4 + float(i)}, 0.01f, 0.9f);
    }
    city.addMediaBox({-12, -12.001f, 0}, {12, -12, 9}, 0.02f, 0.9f);
    city.addMediaBox({-12, -12, 10}, {12, 8, 14}, 0.005f, 0.9f);
    city.addCamera("outside", {9, -30, 16}, {0, 0, 5}, 40);
    city.addCamera("inside", {-3, -8, 3}, {2, 0, 5}, 70);
    city.addCamera("onFace", {0, -20, 4}, {0, 0, 4}, 60);
    return city;
}

// The traversal of --method march asks every box on the ray.
TEST(FieldMediaIds, AreThoseOfTheTraversal) {
    const FlatScene scene = manyBoxes().load();
    RenderSettings march;
    for (const auto& [camera, least] :
         {std::pair{"outside", 6u}, std::pair{"inside", 1u}, std::pair{"onFace", 2u}}) {
        const RenderProduct product = productOf(camera, 173, 97);
        const Frame field = renderOnDevice(scene, product, fieldSettings());
        const Frame traversed = renderOnDevice(scene, product, march);
        EXPECT_EQ(field.mediaId, traversed.mediaId) << camera;
        const std::set<float> ids(field.mediaId.begin(), field.mediaId.end());
        EXPECT_GE(ids.size(), least) << camera;
    }
}

struct ModelCase {
    Emitter emitter;
    Visibility visibility;
    Surfaces surfaces = Surfaces::dim;

    Model model() const {
        return {Lights::all, visibility, emitter, Scattering::single, surfaces};
    }
};

void PrintTo(const ModelCase& c, std::ostream* out) {
    *out << (c.emitter == Emitter::isotropic    ? "isotropic"
             : c.emitter == Emitter::lambertian ? "lambertian"
                                                : "pane")
         << (c.visibility == Visibility::full ? ", hidden" : ", unhidden")
         << (c.surfaces == Surfaces::lit ? ", lit" : "");
}

class FieldModels : public testing::TestWithParam<ModelCase> {};

TEST_P(FieldModels, AgreeWithTheJudge) {
    const FlatScene scene = corner().load();
    const RenderProduct product = some(productOf("corner", 96, 64), 8);
    RenderSettings settings = fieldSettings();
    settings.model = GetParam().model();
    const Frame field = renderOnDevice(scene, product, settings);
    const Frame judge = judged(scene, product, settings.model);
    const GlowErrors errors = glowErrors(field, judge);
    EXPECT_LT(errors.median, 0.005);
    EXPECT_LT(errors.p95, 0.01);
    EXPECT_LT(errors.worst, 0.04);
    for (std::size_t i = 0; i < judge.surface.size(); ++i) {
        EXPECT_NEAR(field.surface[i].y, judge.surface[i].y, 0.01f * judge.surface[i].y);
    }
}

TEST_P(FieldModels, AToggledStateEqualsAFreshBakeToTheBit) {
    SceneBuilder city = corner();
    city.windowEvents = {{2, 1, 0}};
    const FlatScene scene = city.load();
    RenderProduct product = productOf("corner", 64, 42);
    product.frame = 2;
    RenderSettings settings = fieldSettings();
    settings.model = GetParam().model();
    const Frame fresh = renderOnDevice(scene, product, settings);
    RenderDelegate& delegate = testDelegate();
    product.frame = 1;
    EXPECT_NE(renderOnDevice(scene, product, settings).glow, fresh.glow);
    product.frame = 2;
    SceneChanges changes;
    changes.geometry = false;
    delegate.sync(scene, product.camera, product.frame, settings, changes);
    delegate.render(product, settings, {});
    expectSame(delegate.resolve(), fresh);
}

INSTANTIATE_TEST_SUITE_P(
    All, FieldModels,
    testing::Values(ModelCase{Emitter::isotropic, Visibility::full},
                    ModelCase{Emitter::lambertian, Visibility::full},
                    ModelCase{Emitter::pane, Visibility::full, Surfaces::lit},
                    ModelCase{Emitter::isotropic, Visibility::none},
                    ModelCase{Emitter::lambertian, Visibility::none, Surfaces::lit},
                    ModelCase{Emitter::pane, Visibility::none}));

TEST(Field, LightsSurfacesAlsoWithoutHaze) {
    const FlatScene scene = corner().load();
    const RenderProduct product = productOf("corner", 40, 26);
    RenderSettings settings = fieldSettings();
    settings.model.surfaces = Surfaces::lit;
    settings.media = false;
    const Frame field = renderOnDevice(scene, product, settings);
    settings.method = Method::gauss;
    expectSame(field, renderOnDevice(scene, product, settings));
}

TEST(Field, SparseRaysStayWithinTheToleranceOfAllRays) {
    const FlatScene scene = twoWindows().load();
    const RenderProduct product = productOf("front", 301, 203);
    const GlowErrors errors =
        glowErrors(renderOnDevice(scene, product, fieldSettings()),
                   renderOnDevice(scene, product, fieldSettings(GlowRays::all)));
    EXPECT_LT(errors.median, 1e-3);
    EXPECT_LT(errors.worst, 0.01);
    EXPECT_LT(std::abs(errors.bias), 1e-3);
}

// A facade of more panes than a subgroup looks through at once, and haze before half of it.
SceneBuilder manyPanes() {
    SceneBuilder city;
    const uint wall = city.addMaterial(vec3(0.5f));
    city.addBoxBuilding({-6, 0, 0}, {6, 4, 12}, wall);
    for (int k = 0; k < 144; ++k) {
        const vec3 centre{-5.0f + 0.9f * float(k % 12), -0.01f, 1 + 0.9f * float(k / 12)};
        city.addWindow(centre, {0.2f, 0, 0}, {0, 0, 0.25f});
    }
    city.addMediaBox({-6, -4, 0}, {1, 0, 12}, 0.02f, 0.9f);
    city.addCamera("front", {3, -25, 9}, {0, 0, 6}, 40);
    return city;
}

// The first pixel of a cell has its own ray in both, beside other rays in each.
TEST(Field, ARayFindsTheSamePanesWhateverRaysAreBeside) {
    const FlatScene scene = manyPanes().load();
    const RenderProduct product = productOf("front", 97, 65);
    RenderSettings sparse = fieldSettings(), all = fieldSettings(GlowRays::all);
    for (RenderSettings* settings : {&sparse, &all}) {
        settings->tolerance = 0.1;
        settings->model.visibility = Visibility::none;
    }
    const Frame one = renderOnDevice(scene, product, sparse);
    const Frame other = renderOnDevice(scene, product, all);
    std::size_t hazy = 0;
    for (std::size_t y = 0; y < product.height; y += kGlowCell) {
        for (std::size_t x = 0; x < product.width; x += kGlowCell) {
            const std::size_t at = y * product.width + x;
            EXPECT_EQ(one.glow[at], other.glow[at]) << x << ", " << y;
            hazy += other.transmittance[at] < 1;
        }
    }
    EXPECT_GT(hazy, 50u);
}

TEST(Field, PixelsAndTilesEqualTheFrame) {
    const FlatScene scene = twoWindows().load();
    const RenderProduct product = productOf("inside", 131, 90);
    const Frame whole = renderOnDevice(scene, product, fieldSettings());
    const RenderProduct list = some(product, 7);
    const Frame pixels = renderOnDevice(scene, list, fieldSettings());
    for (std::size_t i = 0; i < list.pixels.size(); ++i) {
        const std::size_t at = list.pixels[i].y * product.width + list.pixels[i].x;
        EXPECT_EQ(pixels.glow[i], whole.glow[at]);
        EXPECT_EQ(pixels.beauty[i], whole.beauty[at]);
    }
    RenderProduct tile = product;
    tile.tile = RowRange{30, 37};
    const Frame part = renderOnDevice(scene, tile, fieldSettings());
    for (std::size_t i = 0; i < part.glow.size(); ++i) {
        ASSERT_EQ(part.glow[i], whole.glow[i + std::size_t{30} * product.width]);
    }
}

TEST(Field, IsTheSameEachTime) {
    const FlatScene scene = twoWindows().load();
    const RenderProduct product = productOf("inside", 90, 61);
    const Frame first = renderOnDevice(scene, product, fieldSettings());
    expectSame(first, renderOnDevice(scene, product, fieldSettings()));
}

TEST(Field, BandsCoverEveryRowOnceWithItsNeighbours) {
    for (const std::uint32_t first : {0u, 5u, 64u}) {
        const std::uint32_t count = 337;
        std::uint32_t next = first;
        for (const GlowBand& band : glowBands(100, 500, first, count, 10000)) {
            EXPECT_EQ(band.firstKeptRow, next);
            EXPECT_EQ(band.firstRow % kGlowCell, 0u);
            EXPECT_LE(band.firstRow, band.firstKeptRow - std::min(band.firstKeptRow, kGlowCell));
            next += band.keptRows;
            EXPECT_GE(band.firstRow + band.rows, std::min(500u, next + kGlowCell + 1));
            EXPECT_LE(band.firstRow + band.rows, 500u);
        }
        EXPECT_EQ(next, first + count);
    }
}

// The second difference of a pixel over a dolly, against its value.
TEST(Field, IsSmoothWhereTheCameraMovesByMillimetres) {
    const FlatScene scene = twoWindows().load();
    RenderProduct product = some(productOf("front", 160, 100), 20);
    const RenderSettings settings = fieldSettings();
    std::vector<std::vector<glm::vec3>> steps;
    RenderDelegate& delegate = testDelegate();
    delegate.sync(scene, product.camera, 1, settings, {});
    for (int i = 0; i < 20; ++i) {
        product.cameraOffset = {0.001f * float(i), 0, 0};
        delegate.render(product, settings, {});
        steps.push_back(delegate.resolve().glow);
    }
    for (std::size_t p = 0; p < product.pixels.size(); ++p) {
        for (std::size_t i = 1; i + 1 < steps.size(); ++i) {
            const float bend = steps[i - 1][p].y - 2 * steps[i][p].y + steps[i + 1][p].y;
            EXPECT_LE(std::abs(bend), 0.01f * steps[i][p].y + 1e-6f);
        }
    }
}

TEST(Field, IsBlackWithoutWindowsAndWithoutHaze) {
    SceneBuilder dark = twoWindows();
    dark.windows.clear();
    dark.mediaBoxes.clear();
    dark.lightList.clear();
    dark.buildings[0].windowCount = 0;
    const RenderProduct product = productOf("front", 40, 30);
    SceneBuilder hazy = dark;
    hazy.addMediaBox({-8, -12, 0}, {8, 0, 12}, 0.02f, 0.9f);
    for (const SceneBuilder& city : {dark, hazy}) {
        const Frame frame = renderOnDevice(city.load(), product, fieldSettings());
        for (std::size_t i = 0; i < frame.glow.size(); ++i) {
            ASSERT_EQ(frame.glow[i], glm::vec3(0));
            ASSERT_TRUE(std::isfinite(frame.beauty[i].x));
        }
    }
}

TEST(Field, FollowsTheWindowsThatAreOn) {
    SceneBuilder city = twoWindows();
    const RenderProduct product = productOf("front", 64, 48);
    const Frame both = renderOnDevice(city.load(), product, fieldSettings(GlowRays::all));
    city.windows[1].flags &= ~kWindowOn;
    const Frame first = renderOnDevice(city.load(), product, fieldSettings(GlowRays::all));
    city.windows[0].flags &= ~kWindowOn;
    city.windows[1].flags |= kWindowOn;
    const Frame second = renderOnDevice(city.load(), product, fieldSettings(GlowRays::all));
    for (std::size_t i = 0; i < both.glow.size(); ++i) {
        const glm::vec3 sum = first.glow[i] + second.glow[i];
        EXPECT_NEAR(both.glow[i].y, sum.y, 0.003f * sum.y + 1e-6f);
    }
}

}  // namespace
}  // namespace nightcity
