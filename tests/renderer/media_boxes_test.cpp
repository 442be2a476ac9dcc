// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// No box is missed and none counted twice where faces touch: haze cut into
// boxes transmits what the same haze in one box does.
#include <cmath>

#include <gtest/gtest.h>

#include "device_frame.h"

namespace nightcity {
namespace {

constexpr std::uint32_t kWidth = 240, kHeight = 133;

// The paper's city whose haze is one box of the same outline: buildings win over it.
SceneBuilder inOneBox(const SceneBuilder& city) {
    SceneBuilder whole = city;
    whole.mediaBoxes.clear();
    whole.lightList.clear();
    whole.addMediaBox({-45, -45, 0}, {45, 45, 30}, 0.01f, 0.9f, {});
    return whole;
}

void expectSameTransmittance(const SceneBuilder& cut, const SceneBuilder& whole,
                             const std::string& camera) {
    const RenderProduct product = productOf(camera, kWidth, kHeight);
    RenderSettings settings;
    settings.subdivisions = 1;
    // The one box fills the buildings too: at a wall's very edge, which the raster rounds to a
    // fraction of a pixel, a ray would cross a building's corner through haze in one scene only.
    settings.primary = Primary::rays;
    const Frame frame = renderOnDevice(cut.load(), product, settings);
    const Frame expected = renderOnDevice(whole.load(), product, settings);
    std::size_t inHaze = 0;
    for (std::size_t i = 0; i < frame.transmittance.size(); ++i) {
        ASSERT_NEAR(frame.transmittance[i], expected.transmittance[i], 1e-5)
            << camera << ", pixel " << i % kWidth << ", " << i / kWidth;
        inHaze += expected.transmittance[i] < 1 ? 1 : 0;
    }
    EXPECT_GT(inHaze, frame.transmittance.size() / 100);
}

TEST(MediaBoxes, PaperCamerasSeeCutHazeAsWhole) {
    const SceneBuilder cut = paperCity(4);
    ASSERT_EQ(cut.mediaBoxes.size(), 65u);
    for (const char* camera : {"overview75", "street", "far25"}) {
        expectSameTransmittance(cut, inOneBox(cut), camera);
    }
}

struct Place {
    const char* what;
    vec3 position;
    vec3 target;
};

// Positions and directions that meet faces, edges and corners of the 10 m grid exactly; none on
// a wall with the building in view.
const Place kPlaces[] = {
    {"on a face, looking out", {-5, 0, 12}, {40, 7, 9}},
    {"on a face, looking along it", {-5, -50, 12}, {-5, 50, 12}},
    {"on the outer upper face, along it", {-40, -60, 30}, {-40, 60, 30}},
    {"on the outer lower x face, along it", {-45, -60, 10}, {-45, 60, 10}},
    {"on the outer upper x face, along it", {45, -60, 10}, {45, 60, 10}},
    {"on an edge, along it", {-5, -5, -0.0f + 40}, {-5, -5.001f, 0}},
    {"on an edge, across", {-5, -5, 15}, {5, 5, 15}},
    {"on a corner of the city", {-45, -45, 0}, {45, 45, 30}},
    {"on an upper corner, diagonally down", {45, 45, 30}, {-45, -45, 0}},
    {"on a corner inside, diagonally", {5, -5, 0}, {-35, 35, 30}},
    {"along the street's middle", {0, -50, 10}, {0, 50, 10}},
    {"outside, exactly at a face's height", {-100, 0, 30}, {0, 0, 30}},
    {"straight down on a corner", {5, 5, 90}, {5, 5.0001f, 0}},
};

TEST(MediaBoxes, CamerasOnFacesEdgesAndCornersSeeCutHazeAsWhole) {
    SceneBuilder cut = paperCity(4);
    for (const Place& place : kPlaces) {
        cut.addCamera(place.what, place.position, place.target, 60);
    }
    const SceneBuilder whole = inOneBox(cut);
    for (const Place& place : kPlaces) {
        expectSameTransmittance(cut, whole, place.what);
    }
}

// 4 x 4 x 4 boxes of one cube and no buildings: faces in every direction.
TEST(MediaBoxes, CubeCutInThreeDirectionsTransmitsAsWhole) {
    SceneBuilder cut, whole;
    for (int z = 0; z < 4; ++z) {
        for (int y = 0; y < 4; ++y) {
            for (int x = 0; x < 4; ++x) {
                cut.addMediaBox(vec3(x, y, z), vec3(x + 1, y + 1, z + 1), 0.5f, 1);
            }
        }
    }
    whole.addMediaBox(vec3(0), vec3(4), 0.5f, 1);
    const Place places[] = {
        {"corner to corner", {0, 0, 0}, {4, 4, 4}},   {"centre", {2, 2, 2}, {4, 3, 2}},
        {"along an edge", {-3, 2, 2}, {4, 2, 2}},     {"along the lower face", {-3, 0, 1}, {4, 0, 1}},
        {"along the upper face", {-3, 4, 1}, {4, 4, 1}}, {"from far", {-500, -400, 300}, {2, 2, 2}},
    };
    for (const Place& place : places) {
        const double fov = place.position.x < -100 ? 0.8 : 70;
        cut.addCamera(place.what, place.position, place.target, fov);
        whole.addCamera(place.what, place.position, place.target, fov);
    }
    for (const Place& place : places) {
        expectSameTransmittance(cut, whole, place.what);
    }
}

// The rule lo <= x < hi: on the lower face a ray along it is inside, on the upper one not.
TEST(MediaBoxes, RayInAFaceBelongsToTheBoxAboveIt) {
    SceneBuilder city;
    city.addMediaBox({0, 0, 0}, {8, 1, 1}, 0.1f, 1);
    for (const float y : {0.0f, 1.0f}) {
        SceneBuilder::Camera camera;
        camera.name = y == 0 ? "lower" : "upper";
        CameraFrame frame{};  // the centre pixel's ray is exactly +x
        frame.position = {-5, y, 0.5f};
        frame.tanHalfFov = 0.1f;
        frame.right = {0, -1, 0};
        frame.up = {0, 0, 1};
        frame.forward = {1, 0, 0};
        frame.aspect = 1;
        camera.frames = {frame};
        city.cameras.push_back(camera);
    }
    const FlatScene scene = city.load();
    EXPECT_NEAR(renderOnDevice(scene, productOf("lower", 1, 1), {}).transmittance[0],
                std::exp(-0.8), 1e-6);
    EXPECT_EQ(renderOnDevice(scene, productOf("upper", 1, 1), {}).transmittance[0], 1);
}

TEST(MediaBoxes, ManyBoxesAlongARayAreAllFound) {
    SceneBuilder city;
    for (int i = 0; i < 100; ++i) {
        city.addMediaBox({2.0f * i, -1, -1}, {2.0f * i + 1, 1, 1}, 0.02f, 1);
    }
    city.addCamera("along", {-1, 0, 0}, {10, 0.0001f, 0}, 0.1);
    const Frame frame = renderOnDevice(city.load(), productOf("along", 3, 3), {});
    for (const float transmittance : frame.transmittance) {
        EXPECT_NEAR(transmittance, std::exp(-2.0), 1e-5);
    }
}

}  // namespace
}  // namespace nightcity
