// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which part of a stretch a point sees, found and not stepped over: the plane
// through both cuts a convex face in a chord, and the chord's shadow on the
// stretch is one interval.
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "reference/view_triangle.h"

namespace nightcity {

// Fractions of a stretch.
struct Interval {
    double begin = 1;
    double end = 0;

    bool isEmpty() const { return !(begin < end); }
};

// The fractions that a convex face hides from the apex. Touching hides nothing, nor
// does what lies within a billionth of the distance from the apex.
Interval shadow(const ViewTriangle& view, std::span<const glm::dvec3> face);

// The fractions that see the face, of a plane beyond the apex, through the apex.
Interval passage(const ViewTriangle& view, std::span<const glm::dvec3> face);

// For an apex on the line of the stretch: whether the face lies between the apex
// and the stretch.
bool blocksLine(const ViewTriangle& view, std::span<const glm::dvec3> face);

// What the shadows leave of [0, 1], in order; slivers that rounding explains
// (1e-12) count as hidden. Sorts `shadows`.
std::vector<Interval> unshadowed(std::vector<Interval>& shadows);

}  // namespace nightcity
