// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/pane_polygons.h"

#include <algorithm>

namespace nightcity {

namespace {

// Whether one of the lines has all of the polygon outside.
bool isApart(std::span<const glm::dvec2> polygon, std::span<const PaneLine> lines) {
    return std::any_of(lines.begin(), lines.end(), [&](const PaneLine& line) {
        return std::all_of(polygon.begin(), polygon.end(),
                           [&](glm::dvec2 corner) { return line.at(corner) <= 0; });
    });
}

}  // namespace

void PanePolygons::clear() {
    corners_.clear();
    first_.resize(1);
}

void PanePolygons::add(std::span<const glm::dvec2> corners) {
    if (corners.size() >= 3) {
        corners_.insert(corners_.end(), corners.begin(), corners.end());
        first_.push_back(std::uint32_t(corners_.size()));
    }
}

std::size_t PanePolygons::startAfresh() {
    beforeCorners_.swap(corners_);
    beforeFirst_.swap(first_);
    corners_.clear();
    first_.assign(1, 0);
    return beforeFirst_.size() - 1;
}

// Sutherland and Hodgman 1974, both sides.
void PanePolygons::split(std::span<const glm::dvec2> polygon, const PaneLine& line) {
    inside_.clear();
    outside_.clear();
    glm::dvec2 last = polygon.back();
    double atLast = line.at(last);
    for (const glm::dvec2 corner : polygon) {
        const double at = line.at(corner);
        if ((at > 0) != (atLast > 0)) {
            const glm::dvec2 crossing = last + (corner - last) * (atLast / (atLast - at));
            inside_.push_back(crossing);
            outside_.push_back(crossing);
        }
        (at > 0 ? inside_ : outside_).push_back(corner);
        last = corner;
        atLast = at;
    }
}

void PanePolygons::keepInside(const PaneLine& line) {
    const std::size_t count = startAfresh();
    for (std::size_t i = 0; i < count; ++i) {
        split(before(i), line);
        add(inside_);
    }
}

bool PanePolygons::isOutside(std::span<const PaneLine> lines) const {
    return isApart(corners_, lines);
}

void PanePolygons::subtract(std::span<const PaneLine> lines) {
    if (isOutside(lines)) {
        return;
    }
    const std::size_t count = startAfresh();
    for (std::size_t i = 0; i < count; ++i) {
        if (isApart(before(i), lines)) {
            add(before(i));
            continue;
        }
        rest_.assign(before(i).begin(), before(i).end());
        for (const PaneLine& line : lines) {
            split(rest_, line);
            add(outside_);
            rest_.swap(inside_);
            if (rest_.size() < 3) {
                break;
            }
        }
    }
}

}  // namespace nightcity
