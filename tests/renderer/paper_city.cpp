// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "scene_builder.h"

namespace nightcity {

namespace {

constexpr double kCell = 10;     // m, side of a grid cell and of a building's base
constexpr double kHeight = 30;   // m, of a small building and of every media box
constexpr vec3 kColours[3] = {{1, 0.8f, 0.6f}, {1, 0.9f, 0.8f}, {0.8f, 0.9f, 1}};

// Windows of the face whose outward normal is +x or -x (axis 0) or +y or -y (axis
// 1): the interior vertices of a 5 x 6 grid over 10 x 30 m, 0.01 m off the wall.
void addFace(SceneBuilder& city, glm::dvec2 centre, int axis, double side) {
    const glm::dvec3 normal = axis == 0 ? glm::dvec3(side, 0, 0) : glm::dvec3(0, side, 0);
    const glm::dvec3 along(-normal.y, normal.x, 0);
    for (int row = 1; row <= 5; ++row) {
        for (int column = 1; column <= 4; ++column) {
            const glm::dvec3 p = glm::dvec3(centre, 5.0 * row) + normal * (kCell / 2 + 0.01) +
                                 along * (2.0 * column - kCell / 2);
            city.addWindow(vec3(p), vec3(along * 0.6), vec3(0, 0, 0.75), 50,
                           kColours[city.windows.size() % 3]);
        }
    }
}

// The paper's rule: bounding boxes scaled about their centres, the window's by 1.3,
// the media box's by `reach`, touch.
std::vector<uint> listLights(const SceneBuilder& city, glm::dvec3 lo, glm::dvec3 hi, double reach) {
    const glm::dvec3 centre = (lo + hi) / 2.0;
    const glm::dvec3 half = (hi - lo) / 2.0 * reach;
    std::vector<uint> lights;
    for (uint i = 0; i < city.windows.size(); ++i) {
        const Window& window = city.windows[i];
        const glm::dvec3 extent = glm::abs(glm::dvec3(window.halfU)) + glm::abs(glm::dvec3(window.halfV));
        const glm::dvec3 distance = glm::abs(glm::dvec3(window.centre) - centre);
        if (glm::all(glm::lessThanEqual(distance, half + extent * 1.3))) {
            lights.push_back(i);
        }
    }
    return lights;
}

}  // namespace

SceneBuilder paperCity(uint n, float extinction, float albedo) {
    SceneBuilder city;
    const uint wall = city.addMaterial({0.6f, 0.55f, 0.5f});
    city.ground = GroundPlane{0, city.addMaterial({0.3f, 0.3f, 0.32f})};
    const uint cells = 2 * n + 1;
    const auto corner = [&](uint i) { return (double(i) - n - 0.5) * kCell; };
    for (uint y = 1; y < cells; y += 2) {
        for (uint x = 1; x < cells; x += 2) {
            const glm::dvec2 lo(corner(x), corner(y));
            city.addBoxBuilding(vec3(lo, 0), vec3(lo + kCell, kHeight), wall);
            for (const int axis : {0, 1}) {
                for (const double side : {-1.0, 1.0}) {
                    addFace(city, lo + kCell / 2, axis, side);
                }
            }
        }
    }
    for (uint y = 0; y < cells; ++y) {
        for (uint x = 0; x < cells; ++x) {
            if (x % 2 == 1 && y % 2 == 1) {
                continue;
            }
            const glm::dvec3 lo(corner(x), corner(y), 0);
            const glm::dvec3 hi = lo + glm::dvec3(kCell, kCell, kHeight);
            const double reach = x % 2 == 0 && y % 2 == 0 ? 1.5 : 1.2;
            city.addMediaBox(vec3(lo), vec3(hi), extinction, albedo, listLights(city, lo, hi, reach));
        }
    }
    city.addCamera("overview75", {95, -125, 62}, {0, 0, 6}, 33.141);
    city.addCamera("street", {1.5f, -38, 2}, {0, 10, 14}, 60);
    city.addCamera("far25", {300, -390, 150}, {0, 0, 8}, 27.79);
    return city;
}

}  // namespace nightcity
