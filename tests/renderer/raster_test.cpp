// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What the raster proposes is what ray queries find, but for a few pixels at edges.
#include <cstring>

#include <gtest/gtest.h>

#include "device_frame.h"
#include "passes/triangle_chunks.h"

namespace nightcity {
namespace {

RenderSettings surfaceFrame(Primary primary, std::uint32_t samples = 1) {
    RenderSettings settings;
    settings.media = false;
    settings.primary = primary;
    settings.pixelSamples = samples;
    return settings;
}

// Whether all that depends on the surface is the same to the bit.
bool samePixel(const Frame& a, const Frame& b, std::size_t i) {
    return a.beauty[i] == b.beauty[i] && a.depth[i] == b.depth[i] && a.normal[i] == b.normal[i] &&
           a.materialId[i] == b.materialId[i];
}

bool wasRasterised(const RenderStatistics& statistics) {
    return !statistics.passes.empty() && statistics.passes.front().name == "raster";
}

void expectSameButFor(std::size_t most, const FlatScene& scene, const RenderProduct& product,
                      std::uint32_t samples = 1) {
    RenderStatistics statistics;
    const Frame raster =
        renderOnDevice(scene, product, surfaceFrame(Primary::raster, samples), &statistics);
    EXPECT_TRUE(wasRasterised(statistics));
    const Frame rays =
        renderOnDevice(scene, product, surfaceFrame(Primary::rays, samples), &statistics);
    EXPECT_FALSE(wasRasterised(statistics));
    std::size_t different = 0;
    for (std::size_t i = 0; i < raster.beauty.size(); ++i) {
        different += samePixel(raster, rays, i) ? 0 : 1;
    }
    EXPECT_LE(different, most) << product.camera << " of " << raster.beauty.size();
}

// Walls of all heights, turned and leaning: no wall lies in an axis.
SceneBuilder mixedCity() {
    SceneBuilder city;
    const uint wall = city.addMaterial({0.6f, 0.5f, 0.4f});
    const uint roof = city.addMaterial({0.7f, 0.2f, 0.2f});
    for (int y = 0; y < 6; ++y) {
        for (int x = 0; x < 6; ++x) {
            const float height = 4.0f + float((x * 7 + y * 13) % 11) * 3;
            const vec3 lo(20 * x - 60, 20 * y - 60, 0);
            city.addBoxBuilding(lo, lo + vec3(11, 9, height), wall);
        }
    }
    for (vec3& position : city.positions) {
        position = vec3(0.8f * position.x - 0.6f * position.y, 0.6f * position.x + 0.8f * position.y,
                        position.z * (1 + 0.01f * position.x));
    }
    for (std::size_t i = 0; i < city.triangles.size(); i += 5) {
        city.triangles[i].material = roof;
    }
    city.ground = GroundPlane{0, city.addMaterial({0.3f, 0.3f, 0.3f})};
    city.addCamera("above", {90, -130, 70}, {0, 0, 5}, 40);
    city.addCamera("street", {-3, -40, 2}, {4, 30, 9}, 70);
    return city;
}

TEST(Raster, SeesWhatRaysSeeInThePapersCity) {
    const FlatScene scene = paperCity(4).load();
    for (const char* camera : {"overview75", "street", "far25"}) {
        expectSameButFor(2, scene, productOf(camera, 480, 265));
    }
}

TEST(Raster, SeesWhatRaysSeeAmongWallsOfAllHeightsAndDirections) {
    const FlatScene scene = mixedCity().load();
    for (const char* camera : {"above", "street"}) {
        expectSameButFor(2, scene, productOf(camera, 400, 300));
    }
}

// Jittered projections.
TEST(Raster, SamplesLieWhereTheRaysAre) {
    expectSameButFor(4, paperCity(2).load(), productOf("overview75", 160, 90), 16);
}

TEST(Raster, FollowsALensThatIsShifted) {
    SceneBuilder city = mixedCity();
    city.cameras[0].frames[0].shiftX = 0.7f;
    city.cameras[0].frames[0].shiftY = -0.4f;
    expectSameButFor(2, city.load(), productOf("above", 300, 200));
}

// A wall a centimetre away, one that passes beside the eye and behind it, and one far below.
TEST(Raster, WallsAtTheEyeAreThere) {
    SceneBuilder city;
    const uint wall = city.addMaterial({0.5f, 0.5f, 0.5f});
    city.addBoxBuilding({-30, 0.01f, -3}, {0, 1, 3}, wall);        // in front, a centimetre away
    city.addBoxBuilding({0.2f, -500, -30}, {5, 800, 40}, wall);    // through the camera's plane
    city.addBoxBuilding({-300, 90, -60}, {-20, 400, -20}, wall);
    city.addCamera("eye", {0, 0, 0}, {0, 1, 0}, 75);
    city.addCamera("aslant", {0, 0, 0}, {0.4f, 1, -0.2f}, 100);
    const FlatScene scene = city.load();
    for (const char* camera : {"eye", "aslant"}) {
        expectSameButFor(2, scene, productOf(camera, 301, 203));
    }
    const Frame frame =
        renderOnDevice(scene, productOf("eye", 301, 203), surfaceFrame(Primary::raster));
    EXPECT_NEAR(frame.depth[101 * 301 + 100], 0.01f, 1e-6);
}

// From inside a box its walls are seen from behind.
TEST(Raster, BothFacesCount) {
    SceneBuilder city;
    city.addBoxBuilding({-3, -3, -3}, {3, 3, 3}, city.addMaterial({0.5f, 0.5f, 0.5f}));
    city.addCamera("eye", {0.1f, 0.2f, 0.3f}, {1, 2, 0.5f}, 90);
    expectSameButFor(1, city.load(), productOf("eye", 200, 150));
}

TEST(Raster, ScenesWithoutTrianglesAreRendered) {
    SceneBuilder nothing;
    nothing.addCamera("eye", {0, -20, 1}, {0, 0, 1}, 50);
    SceneBuilder ground = nothing;
    ground.ground = GroundPlane{0, ground.addMaterial({0.5f, 0.5f, 0.5f})};
    for (const SceneBuilder* builder : {&nothing, &ground}) {
        expectSameButFor(0, builder->load(), productOf("eye", 64, 48));
    }
}

// 700 x 500 pixels are two bands, with several samples each rasterised alone; a list of pixels
// is one band. A pixel is the same in all.
TEST(Raster, NeitherBandsNorListsChangeAByte) {
    const FlatScene scene = mixedCity().load();
    RenderProduct product = productOf("above", 701, 499);
    for (const std::uint32_t samples : {1u, 2u}) {
        product.pixels.clear();
        const Frame whole =
            renderOnDevice(scene, product, surfaceFrame(Primary::raster, samples));
        for (std::uint32_t i = 0; i < 701 * 499; i += 7) {
            product.pixels.push_back({i % 701, i / 701});
        }
        const Frame some = renderOnDevice(scene, product, surfaceFrame(Primary::raster, samples));
        std::size_t different = 0;
        for (std::size_t i = 0; i < product.pixels.size(); ++i) {
            const std::size_t from = product.pixels[i].y * std::size_t{701} + product.pixels[i].x;
            different += std::memcmp(&some.beauty[i], &whole.beauty[from], 16) != 0 ||
                                 some.depth[i] != whole.depth[from]
                             ? 1
                             : 0;
        }
        EXPECT_EQ(different, 0u);
    }
}

TEST(TriangleChunks, AreLeftOutOnlyWhereNothingOfThemIsSeen) {
    SceneBuilder city;
    const uint wall = city.addMaterial({0.5f, 0.5f, 0.5f});
    for (int i = 0; i < 400; ++i) {
        const vec3 lo(10 * (i % 20) - 100, 10 * (i / 20) - 100, 0);
        city.addBoxBuilding(lo, lo + vec3(6, 6, 5 + i % 7), wall);
    }
    city.addCamera("eye", {-95, -120, 3}, {-60, 0, 3}, 30);
    const FlatScene scene = city.load();
    const std::vector<TriangleChunk> chunks = chunkTriangles(scene);
    const std::vector<TriangleRun> runs = visibleRuns(
        chunks, scene.camera("eye").at(1), FrameRows{320, 200, 0, 200}, 0);
    std::uint32_t drawn = 0;
    for (const TriangleRun& run : runs) {
        drawn += run.count;
    }
    EXPECT_GT(drawn, 0u);
    EXPECT_LT(drawn, scene.triangles.size());
    expectSameButFor(2, scene, productOf("eye", 320, 200));
}

}  // namespace
}  // namespace nightcity
