// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The panes of one building by plane, and the triangles that they hang on.
#pragma once

#include <vector>

#include "scene/flat_scene.h"

namespace nightcity {

struct FacadeWall {
    glm::dvec3 point;   // m, in the plane of the panes
    glm::dvec3 uAxis;   // unit vectors; uAxis x vAxis = normal, outward
    glm::dvec3 vAxis;
    glm::dvec3 normal;
    std::vector<uint> windows;    // ascending, wholly in front of the triangles
    std::vector<uint> triangles;  // within kWallDistance of the plane
};

// Appends the building's windows that hang on none of the walls to `loose`.
// Walls without a window or without a triangle are left out.
std::vector<FacadeWall> findWalls(const FlatScene& scene, const Building& building,
                                  std::vector<uint>& loose);

}  // namespace nightcity
