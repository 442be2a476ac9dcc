// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What a ray sees of a pane, place by place: the pane less the shadows that convex
// faces throw on it from there.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "reference/hiders.h"
#include "reference/pane_polygons.h"
#include "reference/ray.h"
#include "reference/shadow_intervals.h"
#include "reference/view_triangle.h"

namespace nightcity {

class PaneSight {
public:
    // From the front of the pane; the window must outlive it. `groundHeight`: only what
    // lies on the ray's side of it is seen.
    PaneSight(const LitWindow& window, Hiders hiders, std::optional<double> groundHeight,
              const Ray& ray, const RayPart& part);

    // The parts of the ray that may see some of the pane, in order: the rest is
    // hidden for certain.
    const std::vector<RayPart>& open() const { return open_; }

    // Where an edge of a shadow passes a corner of the pane, or a corner of a shadow
    // an edge of the pane: what is seen has a kink there. m along the ray, rising.
    // Where edges of two shadows meet on the pane it has others.
    const std::vector<double>& kinks() const { return kinks_; }

    // Replaces `seen` by what is seen from a place of the part (m along the ray).
    void seenFrom(double t, PanePolygons& seen) const;

private:
    using Corners = std::array<Interval, 4>;  // what a hider hides from each corner

    // What no hider hides from all corners, and so from the whole pane.
    std::vector<Interval> openFractions(const std::vector<Corners>& shadows) const;
    // Fractions outside which a hider hides nothing of the pane.
    Interval rangeOf(std::size_t hider, const Corners& shadows);
    void addCornerKinks(const std::vector<Corners>& shadows);
    bool mayThrowShadow(std::size_t hider, glm::dvec3 eye) const;
    // Sets the lines that bound a hider's shadow on the pane; none: no shadow.
    void findShadow(std::size_t hider, glm::dvec3 eye, std::vector<PaneLine>& lines) const;
    PaneLine lineThrough(glm::dvec3 eye, glm::dvec3 a, glm::dvec3 b) const;
    double height(glm::dvec3 point) const {
        return glm::dot(window_.normal, point - window_.centre);
    }
    void addKinks(const Interval& fractions);
    void finishKinks();

    const LitWindow& window_;
    Hiders hiders_;  // some may do nothing where the part is open
    Ray ray_;
    RayPart part_;
    PanePolygons whole_;
    bool flat_ = false;  // a corner of the pane lies on the ray's line
    struct Hiding {
        Interval range;        // fractions outside which it hides nothing
        glm::dvec3 normal{0};  // areaVector
        double highest = 0;    // m above the pane's plane
    };
    std::vector<Hiding> hiding_;  // what each hider does
    std::vector<RayPart> open_;
    std::vector<double> kinks_;
};

}  // namespace nightcity
