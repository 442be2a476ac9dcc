// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/pane_sight.h"

#include <algorithm>

#include "reference/hull_region.h"
#include "scene/convex_faces.h"

namespace nightcity {

namespace {

constexpr double kSameFraction = 1e-10;  // of the part: kinks nearer than this are one
constexpr Interval kAlways{0, 1};

Interval both(const Interval& a, const Interval& b) {
    return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

void widen(Interval& range, const Interval& by) {
    if (!by.isEmpty()) {
        range = {std::min(range.begin, by.begin), std::max(range.end, by.end)};
    }
}

}  // namespace

PaneSight::PaneSight(const LitWindow& window, Hiders hiders, std::optional<double> groundHeight,
                     const Ray& ray, const RayPart& part)
    : window_(window), hiders_(std::move(hiders)), ray_(ray), part_(part) {
    whole_.add(std::array<glm::dvec2, 4>{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}});
    const glm::dvec3 begin = ray.at(part.begin), end = ray.at(part.end);
    if (groundHeight) {
        const double side = begin.z + end.z > 2 * *groundHeight ? 1 : -1;
        whole_.keepInside({side * (window.centre.z - *groundHeight),
                           side * glm::dvec2(window.halfU.z, window.halfV.z)});
    }
    std::vector<Corners> shadows;
    std::vector<ViewTriangle> views;
    for (const glm::dvec3 corner : window.corners()) {
        views.emplace_back(corner, begin, end);
        flat_ = flat_ || views.back().isFlat();
    }
    for (std::size_t i = 0; i < hiders_.size(); ++i) {
        Corners& hidden = shadows.emplace_back();
        for (std::size_t c = 0; c < 4; ++c) {
            hidden[c] = views[c].isFlat() ? Interval{} : shadow(views[c], hiders_[i]);
        }
    }
    const std::vector<Interval> open = openFractions(shadows);
    if (open.empty() || whole_.size() == 0) {
        return;
    }
    const double length = part.end - part.begin;
    for (const Interval& fractions : open) {
        open_.push_back({part.begin + fractions.begin * length,
                         part.begin + fractions.end * length});
    }
    const auto corners = window.corners();
    const HullRegion region(corners, ray.at(open_.front().begin), ray.at(open_.back().end));
    for (std::size_t i = 0; i < hiders_.size(); ++i) {
        Hiding& hiding = hiding_.emplace_back();
        if (region.mayTouch(hiders_[i])) {
            hiding.normal = areaVector(hiders_[i]);
            for (const glm::dvec3 corner : hiders_[i]) {
                hiding.highest = std::max(hiding.highest, height(corner));
            }
            hiding.range = rangeOf(i, shadows[i]);
        }
    }
    addCornerKinks(shadows);
    finishKinks();
}

// Where one convex face hides a stretch from each corner it hides it from the whole
// hull: every way between the two crosses the face within the hull of the ways between
// the corners.
std::vector<Interval> PaneSight::openFractions(const std::vector<Corners>& shadows) const {
    std::vector<Interval> hidden;
    for (const Corners& corners : shadows) {
        const Interval common = both(both(corners[0], corners[1]), both(corners[2], corners[3]));
        if (!common.isEmpty()) {
            hidden.push_back(common);
        }
    }
    return unshadowed(hidden);
}

// Two convex outlines that move begin and cease to overlap where a corner of one
// passes an edge of the other: a range begins and ends there, or where the part does.
Interval PaneSight::rangeOf(std::size_t hider, const Corners& shadows) {
    Interval range;
    bool flat = flat_;
    for (const Interval& hidden : shadows) {
        widen(range, hidden);
    }
    const glm::dvec3 begin = ray_.at(part_.begin), end = ray_.at(part_.end);
    const auto pane = window_.corners();
    for (const glm::dvec3 corner : hiders_[hider]) {
        const ViewTriangle view(corner, begin, end);
        flat = flat || view.isFlat();
        if (!view.isFlat()) {
            const Interval passing = passage(view, pane);
            widen(range, passing);
            addKinks(passing);
        }
    }
    if (flat || (mayThrowShadow(hider, begin) && mayThrowShadow(hider, end))) {
        return kAlways;
    }
    if (mayThrowShadow(hider, begin)) {
        range.begin = 0;
    }
    if (mayThrowShadow(hider, end)) {
        range.end = 1;
    }
    return range;
}

void PaneSight::addCornerKinks(const std::vector<Corners>& shadows) {
    for (std::size_t c = 0; c < 4; ++c) {
        std::vector<Interval> hidden;
        for (std::size_t i = 0; i < hiders_.size(); ++i) {
            if (!hiding_[i].range.isEmpty() && !shadows[i][c].isEmpty()) {
                hidden.push_back(shadows[i][c]);
            }
        }
        for (const Interval& seen : unshadowed(hidden)) {
            addKinks(seen);
        }
    }
}

bool PaneSight::mayThrowShadow(std::size_t hider, glm::dvec3 eye) const {
    std::vector<PaneLine> lines;
    findShadow(hider, eye, lines);
    return !lines.empty() && !whole_.isOutside(lines);
}

// The plane through the eye and an edge, where it meets the pane.
PaneLine PaneSight::lineThrough(glm::dvec3 eye, glm::dvec3 a, glm::dvec3 b) const {
    const glm::dvec3 normal = glm::cross(a - eye, b - eye);
    return {glm::dot(normal, window_.centre - eye),
            {glm::dot(normal, window_.halfU), glm::dot(normal, window_.halfV)}};
}

void PaneSight::findShadow(std::size_t hider, glm::dvec3 eye,
                           std::vector<PaneLine>& lines) const {
    lines.clear();
    const Hiding& hiding = hiding_[hider];
    auto face = hiders_[hider];
    const double eyeHeight = height(eye);
    std::vector<glm::dvec3> nearer;
    if (hiding.highest >= eyeHeight) {
        nearer = partAbove(face, -window_.normal,
                           -glm::dot(window_.normal, window_.centre) - eyeHeight);
        face = nearer;
    }
    // The corners run counterclockwise for an eye that the normal points to.
    const double facing = glm::dot(hiding.normal, eye - hiders_[hider][0]);
    if (face.size() < 3 || facing == 0) {
        return;
    }
    for (std::size_t i = 0; i < face.size(); ++i) {
        const glm::dvec3 next = face[i + 1 < face.size() ? i + 1 : 0];
        lines.push_back(facing > 0 ? lineThrough(eye, next, face[i])
                                   : lineThrough(eye, face[i], next));
    }
}

void PaneSight::seenFrom(double t, PanePolygons& seen) const {
    seen = whole_;
    const double fraction = (t - part_.begin) / (part_.end - part_.begin);
    std::vector<PaneLine> shadow;
    for (std::size_t i = 0; i < hiders_.size() && seen.size() > 0; ++i) {
        const Interval& range = hiding_[i].range;
        if (fraction > range.begin && fraction < range.end) {
            findShadow(i, ray_.at(t), shadow);
            if (!shadow.empty()) {
                seen.subtract(shadow);
            }
        }
    }
}

void PaneSight::addKinks(const Interval& fractions) {
    if (!fractions.isEmpty()) {
        kinks_.push_back(fractions.begin);
        kinks_.push_back(fractions.end);
    }
}

// In metres, without doubles and without the ends of the part.
void PaneSight::finishKinks() {
    std::sort(kinks_.begin(), kinks_.end());
    double last = 0;
    std::erase_if(kinks_, [&](double kink) {
        const bool keep = kink > last + kSameFraction && kink < 1 - kSameFraction;
        last = keep ? kink : last;
        return !keep;
    });
    for (double& kink : kinks_) {
        kink = part_.begin + kink * (part_.end - part_.begin);
    }
}

}  // namespace nightcity
