// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/surface_planes.h"

#include <array>
#include <cmath>
#include <map>

namespace nightcity {
namespace {

// Of normals and of distances from the origin (m): planes that agree to this are one. Where a
// plane falls on the border between two steps, two triangles of it may count as two planes;
// more is then integrated than needed, and nothing is wrong.
constexpr double kNormalStep = 1e-3;
constexpr double kDistanceStep = 1e-2;

using PlaneKey = std::array<long long, 5>;

PlaneKey planeKey(const FlatScene& scene, const Triangle& triangle, std::size_t building) {
    const glm::dvec3 a(scene.positions[triangle.vertex.x]);
    const glm::dvec3 b(scene.positions[triangle.vertex.y]);
    const glm::dvec3 c(scene.positions[triangle.vertex.z]);
    const glm::dvec3 across = glm::cross(b - a, c - a);
    const double size = glm::length(across);
    const glm::dvec3 normal = size > 0 ? across / size : glm::dvec3(0);
    return {static_cast<long long>(building), std::llround(normal.x / kNormalStep),
            std::llround(normal.y / kNormalStep), std::llround(normal.z / kNormalStep),
            std::llround(glm::dot(normal, a) / kDistanceStep)};
}

}  // namespace

SurfacePlanes findSurfacePlanes(const FlatScene& scene, const FacadeTable& facades) {
    SurfacePlanes planes;
    uint count = static_cast<uint>(facades.facades.size());  // the first are the facades'
    planes.ofTriangle = facades.triangleFacade;
    std::map<PlaneKey, uint> known;
    for (std::size_t index = 0; index < scene.buildings.size(); ++index) {
        const Building& building = scene.buildings[index];
        for (uint i = 0; i < building.triangleCount; ++i) {
            uint& plane = planes.ofTriangle[building.firstTriangle + i];
            if (plane == kNone) {
                const Triangle& triangle = scene.triangles[building.firstTriangle + i];
                const auto [at, isNew] = known.try_emplace(planeKey(scene, triangle, index), count);
                count += isNew ? 1 : 0;
                plane = at->second;
            }
        }
    }
    for (uint& plane : planes.ofTriangle) {
        plane = plane == kNone ? count++ : plane;  // of no building
    }
    planes.ofWindow.assign(scene.windows.size(), kNone);
    for (std::size_t f = 0; f < facades.facades.size(); ++f) {
        const Facade& facade = facades.facades[f];
        const uint cells = facade.columns * facade.rows;
        for (uint entry = facades.cellStart[facade.firstCell];
             entry < facades.cellStart[facade.firstCell + cells]; ++entry) {
            planes.ofWindow[facades.cellWindow[entry]] = static_cast<uint>(f);
        }
    }
    for (uint& plane : planes.ofWindow) {
        plane = plane == kNone ? count++ : plane;  // loose
    }
    return planes;
}

}  // namespace nightcity
