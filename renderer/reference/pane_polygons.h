// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Parts of a pane: convex polygons in its coordinates, [-1, 1]^2.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace nightcity {

// A line across the pane: a point is inside where this is above 0.
struct PaneLine {
    double constant;
    glm::dvec2 slope;

    double at(glm::dvec2 uv) const { return constant + glm::dot(slope, uv); }
};

class PanePolygons {
public:
    void clear();
    // At least three corners, in order.
    void add(std::span<const glm::dvec2> corners);

    std::size_t size() const { return first_.size() - 1; }
    std::span<const glm::dvec2> operator[](std::size_t index) const {
        return {corners_.data() + first_[index], corners_.data() + first_[index + 1]};
    }

    // Keeps what is inside a line.
    void keepInside(const PaneLine& line);
    // Whether one of the lines has all corners outside: nothing is inside all of them.
    bool isOutside(std::span<const PaneLine> lines) const;
    // Takes away what is inside all the lines, a convex area.
    void subtract(std::span<const PaneLine> lines);

private:
    std::span<const glm::dvec2> before(std::size_t index) const {
        return {beforeCorners_.data() + beforeFirst_[index],
                beforeCorners_.data() + beforeFirst_[index + 1]};
    }
    // Empties the list; what it held is `before`. Returns how many those are.
    std::size_t startAfresh();
    // Cuts one polygon along a line.
    void split(std::span<const glm::dvec2> polygon, const PaneLine& line);

    std::vector<glm::dvec2> corners_;
    std::vector<std::uint32_t> first_{0};  // into corners_, one more than polygons
    // Kept between calls for their memory: what was there before, and a cut.
    std::vector<glm::dvec2> beforeCorners_, rest_, inside_, outside_;
    std::vector<std::uint32_t> beforeFirst_;
};

}  // namespace nightcity
