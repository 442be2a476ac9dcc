// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Frames from the device: sums, samples, bands, pixel lists, surfaces, the night.
#include <cmath>
#include <cstring>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "device_frame.h"
#include "errors.h"
#include "reference/reference_renderer.h"

namespace nightcity {
namespace {

template <typename T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expectSameBytes(const Frame& a, const Frame& b) {
    EXPECT_TRUE(sameBytes(a.beauty, b.beauty));
    EXPECT_TRUE(sameBytes(a.glow, b.glow));
    EXPECT_TRUE(sameBytes(a.surface, b.surface));
    EXPECT_TRUE(sameBytes(a.transmittance, b.transmittance));
    EXPECT_TRUE(sameBytes(a.depth, b.depth));
    EXPECT_TRUE(sameBytes(a.normal, b.normal));
    EXPECT_TRUE(sameBytes(a.mediaId, b.mediaId));
    EXPECT_TRUE(sameBytes(a.materialId, b.materialId));
}

RenderSettings quick() {
    RenderSettings settings;
    settings.subdivisions = 3;
    return settings;
}

TEST(Frame, BeautyIsSurfacePlusGlowAlsoAtSilhouettes) {
    const FlatScene scene = paperCity(2).load();
    RenderSettings settings = quick();
    settings.pixelSamples = 16;
    const Frame frame = renderOnDevice(scene, productOf("overview75", 96, 53), settings);
    double glow = 0;
    for (std::size_t i = 0; i < frame.beauty.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_FLOAT_EQ(frame.beauty[i][c], frame.surface[i][c] + frame.glow[i][c]);
        }
        glow += frame.glow[i].y;
    }
    EXPECT_GT(glow, 0);
}

// What a pixel is worth at an edge: every sample on both sides of it is where the judge has it.
TEST(Frame, SixteenSamplesAtSilhouettesAgreeWithDoublePrecision) {
    const FlatScene scene = paperCity(4).load();
    for (const Filter filter : {Filter::box, Filter::gauss}) {
        RenderSettings settings = quick();
        settings.pixelSamples = 16;
        settings.filter = filter;
        settings.seed = 5;
        RenderProduct product = productOf("overview75", 480, 265);
        for (std::uint32_t x = 100; x < 400; x += 2) {
            product.pixels.push_back({x, 105 + x % 40});  // across roofs, walls, windows
        }
        const Frame frame = renderOnDevice(scene, product, settings);
        const Frame reference = renderReference(scene, product, settings, {}).frame;
        std::size_t mixed = 0;
        for (std::size_t i = 0; i < product.pixels.size(); ++i) {
            EXPECT_NEAR(frame.transmittance[i], reference.transmittance[i], 1e-5);
            mixed += reference.beauty[i].a > 0 && reference.depth[i] == kSkyDepth ? 1 : 0;
            for (int c = 0; c < 3; ++c) {
                const float expected = reference.surface[i][c];
                EXPECT_NEAR(frame.surface[i][c], expected, 1e-5f * expected + 1e-7f);
            }
        }
        EXPECT_LT(glowErrors(frame, reference).worst, 1e-4);
    }
}

TEST(Frame, IsTheSameBytesTwice) {
    const FlatScene scene = paperCity(2).load();
    const RenderProduct product = productOf("overview75", 120, 70);
    expectSameBytes(renderOnDevice(scene, product, quick()),
                    renderOnDevice(scene, product, quick()));
}

// The rows of a tile, put below each other, are the frame, whatever the method.
TEST(Frame, TilesAreTheFrameToTheByte) {
    const FlatScene scene = paperCity(1).load();
    RenderSettings settings = quick();
    settings.samples = 4;
    for (const Method method : {Method::march, Method::path, Method::reference}) {
        settings.method = method;
        const auto render = [&](const RenderProduct& product) {
            return method == Method::reference
                       ? renderReference(scene, product, settings, {}).frame
                       : renderOnDevice(scene, product, settings);
        };
        RenderProduct product = productOf("street", 32, 18);
        const Frame whole = render(product);
        Frame joined;
        for (std::uint32_t row : {0u, 5u, 6u}) {
            product.tile = RowRange{row, row == 0 ? 5u : row == 5 ? 1u : 12u};
            const Frame tile = render(product);
            ASSERT_EQ(tile.height, product.tile->count);
            const auto append = [](auto& all, const auto& more) {
                all.insert(all.end(), more.begin(), more.end());
            };
            append(joined.beauty, tile.beauty);
            append(joined.glow, tile.glow);
            append(joined.surface, tile.surface);
            append(joined.transmittance, tile.transmittance);
            append(joined.depth, tile.depth);
            append(joined.normal, tile.normal);
            append(joined.mediaId, tile.mediaId);
            append(joined.materialId, tile.materialId);
            append(joined.glowError, tile.glowError);
        }
        expectSameBytes(joined, whole);
        EXPECT_TRUE(sameBytes(joined.glowError, whole.glowError));
    }
}

// 640 x 500 pixels are more than a band; a list makes other bands of them.
TEST(Frame, NeitherBandsNorPixelListsChangeAByte) {
    const FlatScene scene = paperCity(2).load();
    RenderProduct product = productOf("overview75", 640, 500);
    const Frame whole = renderOnDevice(scene, product, quick());
    for (std::uint32_t i = 0; i < 640 * 500; i += 37) {
        product.pixels.push_back({(i * 7919u) % 640, i / 640});
    }
    const Frame some = renderOnDevice(scene, product, quick());
    ASSERT_EQ(some.width, product.pixels.size());
    Frame expected;
    expected.resize(some.width, 1);
    for (std::size_t i = 0; i < product.pixels.size(); ++i) {
        const std::size_t from = product.pixels[i].y * 640u + product.pixels[i].x;
        expected.beauty[i] = whole.beauty[from];
        expected.glow[i] = whole.glow[from];
        expected.surface[i] = whole.surface[from];
        expected.transmittance[i] = whole.transmittance[from];
        expected.depth[i] = whole.depth[from];
        expected.normal[i] = whole.normal[from];
        expected.mediaId[i] = whole.mediaId[from];
        expected.materialId[i] = whole.materialId[from];
    }
    expectSameBytes(some, expected);
}

TEST(Frame, WithoutMediaIsTheSurfaceFrame) {
    const FlatScene scene = paperCity(2).load();
    RenderProduct product = productOf("overview75", 160, 90);
    RenderSettings settings = quick();
    const Frame hazy = renderOnDevice(scene, product, settings);
    settings.media = false;
    RenderStatistics statistics;
    const Frame clear = renderOnDevice(scene, product, settings, &statistics);
    EXPECT_EQ(statistics.lightEvaluations, 0u);
    std::size_t surfaces = 0;
    for (std::size_t i = 0; i < clear.beauty.size(); ++i) {
        EXPECT_EQ(clear.transmittance[i], 1);
        EXPECT_EQ(clear.glow[i], glm::vec3(0));
        EXPECT_EQ(clear.mediaId[i], -1);
        EXPECT_EQ(clear.depth[i], hazy.depth[i]);
        for (int c = 0; c < 3; ++c) {
            EXPECT_FLOAT_EQ(clear.beauty[i][c] * hazy.transmittance[i], hazy.surface[i][c]);
        }
        surfaces += clear.depth[i] < kSkyDepth ? 1 : 0;
    }
    EXPECT_GT(surfaces, clear.beauty.size() / 2);
}

TEST(Frame, ProgressRunsToTheEnd) {
    const FlatScene scene = paperCity(1).load();
    RenderDelegate& delegate = testDelegate();
    delegate.sync(scene, "overview75", 1, quick(), {});
    std::vector<double> done;
    delegate.render(productOf("overview75", 640, 500), quick(),
                    [&done](double share) { done.push_back(share); });
    ASSERT_GE(done.size(), 2u);
    EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
    EXPECT_GT(done.front(), 0);
    EXPECT_DOUBLE_EQ(done.back(), 1);
}

TEST(Frame, PixelOutsideIsRefusedByName) {
    const FlatScene scene = paperCity(1).load();
    RenderProduct product = productOf("overview75", 64, 50);
    product.pixels = {{3, 4}, {64, 0}};
    EXPECT_THROW(renderOnDevice(scene, product, quick()), UsageError);
}

TEST(Frame, CameraOffsetMovesTheCamera) {
    SceneBuilder city = paperCity(1);
    SceneBuilder::Camera moved = city.cameras[0];
    moved.name = "moved";
    moved.frames[0].position += vec3(0.5f, 0.25f, 2);
    city.cameras.push_back(moved);
    const FlatScene scene = city.load();
    RenderProduct product = productOf(city.cameras[0].name, 60, 40);
    product.cameraOffset = {0.5f, 0.25f, 2};
    const Frame offset = renderOnDevice(scene, product, quick());
    const Frame expected = renderOnDevice(scene, productOf("moved", 60, 40), quick());
    EXPECT_LT(glowErrors(offset, expected).worst, 1e-4);
}

// A wall at y = 0 that faces -y, seen from 20 m.
SceneBuilder wall() {
    SceneBuilder city;
    city.addBoxBuilding({-10, 0, -10}, {10, 4, 10}, city.addMaterial({0.5f, 0.25f, 0.125f}));
    city.addCamera("front", {0, -20, 0}, {0, 0, 0}, 60);
    return city;
}

void expectAgreementAt(const FlatScene& scene, const RenderProduct& product) {
    const Frame frame = renderOnDevice(scene, product, quick());
    const Frame reference = renderReference(scene, product, quick(), {}).frame;
    std::size_t different = 0;
    for (std::size_t i = 0; i < frame.surface.size(); ++i) {
        const glm::vec3 error = glm::abs(frame.surface[i] - reference.surface[i]);
        const bool same = error.x <= 1e-5f * reference.surface[i].x + 1e-7f &&
                          glm::distance(frame.normal[i], reference.normal[i]) < 1e-4f &&
                          frame.materialId[i] == reference.materialId[i] &&
                          std::abs(frame.depth[i] / reference.depth[i] - 1) < 1e-5f;
        different += same ? 0 : 1;
    }
    EXPECT_EQ(different, 0u) << product.camera;
}

TEST(Surfaces, RolledPaneIsSeenWhereItIs) {
    SceneBuilder city = wall();
    const float c = std::cos(0.5f), s = std::sin(0.5f);
    city.addWindow({1, -0.01f, 2}, 2.0f * vec3(c, 0, s), 1.0f * vec3(-s, 0, c));
    const FlatScene scene = city.load();
    const RenderProduct product = productOf("front", 201, 151);
    expectAgreementAt(scene, product);
    const Frame frame = renderOnDevice(scene, product, quick());
    // Half edges 2 and 1 m: 8 m^2 of 400 m^2 wall; L = P / (pi A).
    const float radiance = 50 / (std::numbers::pi_v<float> * 8);
    std::size_t lit = 0, walls = 0;
    for (const glm::vec3& surface : frame.surface) {
        lit += std::abs(surface.x - radiance) < 1e-4f ? 1 : 0;
        walls += surface.x > 0 ? 1 : 0;
    }
    EXPECT_NEAR(double(lit) / double(walls), 8.0 / 400, 0.002);
}

TEST(Surfaces, LoosePanesAndSpheresAreAsTheJudgeHasThem) {
    SceneBuilder city = wall();
    city.addWindow({-4, -6, 3}, {1, 0, 0.2f}, {-0.2f, 0, 1}, 80, {1, 0.5f, 0.2f}, false);
    city.addWindow({-4, -3, 3}, {3, 0, 0}, {0, 0, 3}, 80, {0.2f, 0.5f, 1}, false);  // behind it
    city.addWindow({4, -5, -3}, {-1, 0, 0}, {0, 0, 1}, 80, vec3(1), false);  // its back
    city.addWindow({5, -2, 5}, {0.5f, 0, 0}, {0, 0, 0.5f}, 80, vec3(1), false);
    city.windows.back().flags |= kWindowSphere;
    city.addWindow({4, 8, 0}, {1, 0, 0}, {0, 0, 1}, 80, vec3(1), false);  // behind the wall
    expectAgreementAt(city.load(), productOf("front", 160, 120));
}

TEST(Surfaces, TextureIsFilteredInLinearLight) {
    SceneBuilder city = wall();
    city.texels = {0xff0000ff, 0xff00ff00, 0xffff0000, 0xff808080, 0xff204060, 0xffffffff};
    city.materials[0].firstTexel = 0;
    city.materials[0].width = 3;
    city.materials[0].height = 2;
    for (const vec3& position : city.positions) {
        city.texcoords.push_back({position.x * 0.13f + 0.4f, position.z * 0.21f - 0.3f});
    }
    const FlatScene scene = city.load();
    const RenderProduct product = productOf("front", 101, 77);
    const Frame frame = renderOnDevice(scene, product, quick());
    const Frame reference = renderReference(scene, product, quick(), {}).frame;
    for (std::size_t i = 0; i < frame.surface.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(frame.surface[i][c], reference.surface[i][c], 2e-6);  // of at most 0.05
        }
    }
}

TEST(Night, EventsSwitchWindowsByTheFrame) {
    SceneBuilder city = wall();
    city.addWindow({-3, -0.01f, 0}, {1, 0, 0}, {0, 0, 1});
    city.addWindow({3, -0.01f, 0}, {1, 0, 0}, {0, 0, 1});
    city.windows[1].flags &= ~kWindowOn;
    city.windowEvents = {{2, 0, 0}, {2.5f, 1, 1}, {4, 0, 1}};
    city.addMediaBox({-10, -5, -10}, {10, 0, 10}, 0.02f, 0.9f, {0, 1});
    city.editManifest = [](nlohmann::json& manifest) { manifest["frames"]["last"] = 5; };
    const FlatScene scene = city.load();
    const bool expected[5][2] = {{true, false}, {false, false}, {false, true}, {true, true},
                                 {true, true}};
    for (int frame = 1; frame <= 5; ++frame) {
        RenderProduct product = productOf("front", 41, 31);
        product.frame = frame;
        RenderStatistics statistics;
        const Frame image = renderOnDevice(scene, product, quick(), &statistics);
        float brightest[2] = {0, 0};
        for (std::size_t i = 0; i < image.surface.size(); ++i) {
            float& side = brightest[i % 41 < 20 ? 0 : 1];
            side = std::max(side, image.surface[i].x);
        }
        for (int window = 0; window < 2; ++window) {
            EXPECT_EQ(brightest[window] > 1, expected[frame - 1][window]) << frame;
        }
        EXPECT_EQ(statistics.lightEvaluations > 0, expected[frame - 1][0] || expected[frame - 1][1]);
    }
}

// Every part of a scene may be missing.
TEST(EmptyScenes, AreRendered) {
    const vec3 eye(0, -20, 1), target(0, 0, 1);
    SceneBuilder nothing;
    nothing.addCamera("eye", eye, target, 50);
    SceneBuilder haze = nothing;
    haze.addMediaBox({-2, -2, 0}, {2, 2, 3}, 0.1f, 0.9f);
    SceneBuilder ground = nothing;
    ground.ground = GroundPlane{0, ground.addMaterial({0.5f, 0.5f, 0.5f})};
    SceneBuilder walls = nothing;
    walls.addBoxBuilding({-3, 0, 0}, {3, 6, 9}, walls.addMaterial({0.5f, 0.5f, 0.5f}));
    for (const SceneBuilder* builder : {&nothing, &haze, &ground, &walls}) {
        const FlatScene scene = builder->load();
        for (const LightStorage storage : {LightStorage::uniform, LightStorage::storage}) {
            RenderSettings settings = quick();
            settings.lightStorage = storage;
            const RenderProduct product = productOf("eye", 31, 23);
            const Frame frame = renderOnDevice(scene, product, settings);
            const Frame reference = renderReference(scene, product, settings, {}).frame;
            for (std::size_t i = 0; i < frame.beauty.size(); ++i) {
                for (int c = 0; c < 4; ++c) {
                    ASSERT_NEAR(frame.beauty[i][c], reference.beauty[i][c], 1e-6);
                }
                ASSERT_EQ(frame.depth[i] == kSkyDepth, reference.depth[i] == kSkyDepth);
            }
        }
    }
}

}  // namespace
}  // namespace nightcity
