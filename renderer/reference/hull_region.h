// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Everything between a source and a stretch, to ask what may lie in between.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scene/box_tree.h"

namespace nightcity {

// The hull of a point, a rectangle or a box, and of a stretch, as slabs along a few
// directions: it holds the hull, and little more.
class HullRegion {
public:
    // `source` holds the corners: at [0], [1] and the last are three of a rectangle
    // about one corner, [0]; of a box the first four are such a rectangle.
    HullRegion(std::span<const glm::dvec3> source, glm::dvec3 begin, glm::dvec3 end);

    // Never false for what touches the hull.
    bool mayTouch(const Bounds& box) const;
    bool mayTouch(std::span<const glm::dvec3> convexFace) const;

private:
    struct Slab {
        glm::dvec3 axis, size;  // unit vector, and its absolute values
        double least, most;
    };

    void addSlab(std::span<const glm::dvec3> points, glm::dvec3 direction);

    Bounds bounds_;
    std::vector<Slab> slabs_;
};

}  // namespace nightcity
