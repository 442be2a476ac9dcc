// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/facades.h"

#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "scene_builder.h"

namespace nightcity {
namespace {

// What the shader does: the windows of the cell where a point of the plane lies.
std::set<uint> windowsAt(const FacadeTable& table, uint facadeIndex, vec3 point) {
    const Facade& facade = table.facades[facadeIndex];
    const int column = int(std::floor(glm::dot(point - facade.origin, facade.uAxis) / facade.cellSize.x));
    const int row = int(std::floor(glm::dot(point - facade.origin, facade.vAxis) / facade.cellSize.y));
    if (column < 0 || row < 0 || column >= int(facade.columns) || row >= int(facade.rows)) {
        return {};
    }
    const uint cell = facade.firstCell + uint(row) * facade.columns + uint(column);
    return {table.cellWindow.begin() + table.cellStart[cell],
            table.cellWindow.begin() + table.cellStart[cell + 1]};
}

uint facadeOf(const FacadeTable& table, uint window) {
    for (uint f = 0; f < table.facades.size(); ++f) {
        const Facade& facade = table.facades[f];
        for (uint c = 0; c < facade.columns * facade.rows; ++c) {
            for (uint k = table.cellStart[facade.firstCell + c]; k < table.cellStart[facade.firstCell + c + 1]; ++k) {
                if (table.cellWindow[k] == window) {
                    return f;
                }
            }
        }
    }
    return kNone;
}

void expectEveryPointFindsItsWindow(const FlatScene& scene, const FacadeTable& table) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(-1, 1);
    const std::set<uint> loose(table.looseWindows.begin(), table.looseWindows.end());
    for (uint w = 0; w < scene.windows.size(); ++w) {
        if (loose.contains(w)) {
            EXPECT_EQ(facadeOf(table, w), kNone);
            continue;
        }
        const uint facade = facadeOf(table, w);
        ASSERT_NE(facade, kNone) << "window " << w;
        const Window& window = scene.windows[w];
        for (int i = 0; i < 8; ++i) {
            const vec3 point = window.centre + unit(random) * window.halfU + unit(random) * window.halfV;
            ASSERT_TRUE(windowsAt(table, facade, point).contains(w)) << "window " << w;
        }
    }
}

TEST(Facades, PaperCityHasOneFacadeAWall) {
    const FlatScene scene = paperCity(2).load();
    const FacadeTable table = buildFacades(scene);
    EXPECT_EQ(table.facades.size(), 4u * 4u);
    EXPECT_TRUE(table.looseWindows.empty());
    // Two triangles of each wall, none of the roofs and floors.
    EXPECT_EQ(std::count(table.triangleFacade.begin(), table.triangleFacade.end(), kNone), 4 * 4);
    expectEveryPointFindsItsWindow(scene, table);
    for (uint t = 0; t < scene.triangles.size(); ++t) {
        if (table.triangleFacade[t] == kNone) {
            continue;
        }
        const Facade& facade = table.facades[table.triangleFacade[t]];
        const uvec3 v = scene.triangles[t].vertex;
        const vec3 normal = glm::cross(scene.positions[v.y] - scene.positions[v.x],
                                       scene.positions[v.z] - scene.positions[v.x]);
        EXPECT_GT(glm::dot(glm::normalize(normal), glm::cross(facade.uAxis, facade.vAxis)), 0.999f);
    }
}

TEST(Facades, RolledPanesAreFound) {
    SceneBuilder city;
    city.addBoxBuilding({0, 0, 0}, {40, 10, 40}, city.addMaterial(vec3(0.5f)));
    std::mt19937 random(3);
    for (int i = 0; i < 200; ++i) {
        const float angle = float(i) * 0.37f;
        const vec3 u(std::cos(angle), 0, std::sin(angle));
        const vec3 v(-std::sin(angle), 0, std::cos(angle));  // u x v = -y, outward
        city.addWindow({3 + float(i % 15) * 2.2f, -0.01f, 3 + float(i / 15) * 2.4f}, 0.8f * u, 0.3f * v);
    }
    const FlatScene scene = city.load();
    const FacadeTable table = buildFacades(scene);
    EXPECT_EQ(table.facades.size(), 1u);
    EXPECT_TRUE(table.looseWindows.empty());
    expectEveryPointFindsItsWindow(scene, table);
}

TEST(Facades, ObliqueWallsFarFromTheOrigin) {
    SceneBuilder city;
    const uint material = city.addMaterial(vec3(0.5f));
    city.addBoxBuilding({-20, -20, 0}, {20, 20, 30}, material);
    const auto place = [](vec3 p) {  // turned by 0.3 about z, then moved
        return vec3(std::cos(0.3f) * p.x - std::sin(0.3f) * p.y + 900,
                    std::sin(0.3f) * p.x + std::cos(0.3f) * p.y - 700, p.z);
    };
    for (vec3& p : city.positions) {
        p = place(p);
    }
    for (int i = 0; i < 60; ++i) {
        const vec3 centre(float(i % 10) * 3 - 15, -20.01f, 3 + float(i / 10) * 4.0f);
        city.addWindow(place(centre), place({0.6f, 0, 0}) - place({0, 0, 0}), {0, 0, 0.75f});
    }
    const FlatScene scene = city.load();
    const FacadeTable table = buildFacades(scene);
    EXPECT_EQ(table.facades.size(), 1u);
    EXPECT_TRUE(table.looseWindows.empty());
    expectEveryPointFindsItsWindow(scene, table);
}

TEST(Facades, PanesWithoutAWallAreLoose) {
    SceneBuilder city;
    city.addBoxBuilding({0, 0, 0}, {10, 10, 30}, city.addMaterial(vec3(0.5f)));
    const vec3 u(0.6f, 0, 0), v(0, 0, 0.75f);  // outward is -y
    city.addWindow({5, -0.01f, 5}, u, v);      // 0: on the wall
    city.addWindow({5, -0.2f, 10}, u, v);      // 1: too far in front of it
    city.addWindow({9.8f, -0.01f, 15}, u, v);  // 2: hangs over the corner
    city.addWindow({5, -0.01f, 20}, -u, v);    // 3: shines into the wall
    city.addWindow({5, -0.01f, 25}, u, v);     // 4: a sphere
    city.windows[4].flags |= kWindowSphere;
    city.addWindow({5, -0.01f, 8}, u, v, 50, vec3(1), false);  // 5: of no building
    const FlatScene scene = city.load();
    const FacadeTable table = buildFacades(scene);
    EXPECT_EQ(table.looseWindows, (std::vector<uint>{1, 2, 3, 4, 5}));
    EXPECT_EQ(table.facades.size(), 1u);
    expectEveryPointFindsItsWindow(scene, table);
}

TEST(Facades, CellsStayFewWhenPanesAreTinyAndFarApart) {
    SceneBuilder city;
    city.addBoxBuilding({0, 0, 0}, {5000, 10, 4000}, city.addMaterial(vec3(0.5f)));
    city.addWindow({1, -0.01f, 1}, {0.05f, 0, 0}, {0, 0, 0.05f});
    city.addWindow({4999, -0.01f, 3999}, {0.05f, 0, 0}, {0, 0, 0.05f});
    city.addWindow({2500, -0.01f, 2000}, {0.05f, 0, 0}, {0, 0, 0.05f});
    const FlatScene scene = city.load();
    const FacadeTable table = buildFacades(scene);
    EXPECT_LE(table.cellStart.size(), 64u);
    expectEveryPointFindsItsWindow(scene, table);
}

TEST(Facades, ManyPlanesInOneBuildingTakeNoQuadraticTime) {
    SceneBuilder city;
    city.addBoxBuilding({-200, -200, 0}, {200, 200, 400}, city.addMaterial(vec3(0.5f)));
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 20000; ++i) {
        const vec3 outward = glm::normalize(vec3(normal(random), normal(random), normal(random)));
        const vec3 u = glm::normalize(glm::cross(outward, vec3(0.3f, 0.5f, 0.8f)));
        city.addWindow(outward * 150.0f, u, glm::cross(outward, u));
    }
    const FlatScene scene = city.load();
    EXPECT_EQ(buildFacades(scene).looseWindows.size(), scene.windows.size());
}

TEST(Facades, SceneWithoutBuildingsOrWindows) {
    EXPECT_TRUE(buildFacades(SceneBuilder().load()).facades.empty());
    SceneBuilder bare;
    bare.addBoxBuilding({0, 0, 0}, {1, 1, 1}, bare.addMaterial(vec3(0.5f)));
    EXPECT_EQ(buildFacades(bare.load()).triangleFacade.size(), 12u);
}

}  // namespace
}  // namespace nightcity
