// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// How high roofs reach, seen from above.
#include <gtest/gtest.h>

#include "passes/height_map.h"
#include "scene_builder.h"

namespace nightcity {
namespace {

SceneBuilder withCamera() {
    SceneBuilder builder;
    builder.addMaterial(vec3(0.5f));
    builder.addCamera("eye", vec3(0, -50, 20), vec3(0), 40);
    builder.addMediaBox(vec3(-50), vec3(50), 0.01f, 0.9f);
    return builder;
}

float at(const HeightMap& map, vec2 place) {
    const vec2 cell = (place - map.origin) / map.cellSide;
    return map.heights.at(std::size_t(cell.y) * map.counts.x + std::size_t(cell.x));
}

TEST(HeightMap, HasTheHighestRoofOverACell) {
    SceneBuilder builder = withCamera();
    builder.addBoxBuilding(vec3(0), vec3(10, 10, 7), 0);
    builder.addBoxBuilding(vec3(5, 0, 0), vec3(20, 10, 12), 0);
    builder.addBoxBuilding(vec3(30, 20, 0), vec3(40, 40, 3), 0);
    const FlatScene scene = builder.load();
    const HeightMap map = buildHeightMap(ConvexFaces(scene), 0.5f);
    EXPECT_EQ(map.origin, vec2(0));
    EXPECT_FLOAT_EQ(at(map, vec2(2.2f, 5.1f)), 7);
    EXPECT_FLOAT_EQ(at(map, vec2(7.2f, 5.1f)), 12);
    EXPECT_FLOAT_EQ(at(map, vec2(35.2f, 30.1f)), 3);
    EXPECT_EQ(at(map, vec2(25.2f, 5.1f)), kNoRoof);
    EXPECT_EQ(at(map, vec2(2.2f, 15.1f)), kNoRoof);
}

TEST(HeightMap, FollowsASlopingRoof) {
    SceneBuilder builder = withCamera();
    builder.addBoxBuilding(vec3(0), vec3(10, 10, 4), 0);
    for (vec3& corner : builder.positions) {
        corner.z += corner.z > 0 ? 0.3f * corner.x : 0;
    }
    const FlatScene scene = builder.load();
    const HeightMap map = buildHeightMap(ConvexFaces(scene), 0.5f);
    EXPECT_NEAR(at(map, vec2(1.25f, 5.1f)), 4 + 0.3 * 1.25, 1e-4);
    EXPECT_NEAR(at(map, vec2(8.75f, 5.1f)), 4 + 0.3 * 8.75, 1e-4);
}

TEST(HeightMap, KeepsItsMemory) {
    SceneBuilder builder = withCamera();
    builder.addBoxBuilding(vec3(0), vec3(10, 10, 7), 0);
    builder.addBoxBuilding(vec3(9000, 7000, 0), vec3(9030, 7030, 5), 0);
    const FlatScene scene = builder.load();
    const HeightMap map = buildHeightMap(ConvexFaces(scene), 0.5f);
    EXPECT_LE(map.heights.size() * sizeof(float), kHeightMapBytes);
    EXPECT_GT(map.heights.size() * sizeof(float), kHeightMapBytes * 9 / 10);
    EXPECT_FLOAT_EQ(at(map, vec2(9015, 7015)), 5);
}

TEST(HeightMap, IsOneOpenCellWithoutRoofs) {
    const HeightMap map = buildHeightMap(ConvexFaces(withCamera().load()), 0.5f);
    EXPECT_EQ(map.counts, uvec2(1));
    EXPECT_EQ(map.heights, std::vector<float>{kNoRoof});
}

}  // namespace
}  // namespace nightcity
