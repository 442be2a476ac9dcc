// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <glm/glm.hpp>

namespace nightcity {

// Joins a triangle to a convex planar face where they share an edge, lie in one
// plane (1 micrometre) and the union is convex. Returns whether it did.
bool joinTriangle(std::vector<glm::dvec3>& face, const std::array<glm::dvec3, 3>& triangle);

}  // namespace nightcity
