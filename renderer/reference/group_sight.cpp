// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/group_sight.h"

#include <algorithm>
#include <cmath>

#include "scene/convex_faces.h"

namespace nightcity {

namespace {

constexpr std::size_t kKeptBlockers = 12;

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

// Whether a way crosses a convex face, strictly inside both.
bool crosses(std::span<const glm::dvec3> face, glm::dvec3 normal, glm::dvec3 from,
             glm::dvec3 to) {
    const double before = glm::dot(normal, from - face[0]);
    const double after = glm::dot(normal, to - face[0]);
    if (!((before > 0 && after < 0) || (before < 0 && after > 0))) {
        return false;
    }
    const glm::dvec3 place = from + (to - from) * (before / (before - after));
    glm::dvec3 last = face.back();
    for (const glm::dvec3 corner : face) {
        if (!(glm::dot(glm::cross(corner - last, place - last), normal) > 0)) {
            return false;
        }
        last = corner;
    }
    return true;
}

}  // namespace

AlongRay::AlongRay(const Ray& ray) : ray_(ray) {
    const glm::dvec3 size = glm::abs(ray.direction);
    const glm::dvec3 aside = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                             : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                                  : glm::dvec3(0, 0, 1);
    right_ = glm::normalize(glm::cross(ray.direction, aside));
    up_ = glm::cross(ray.direction, right_);
}

Wedge::Wedge(std::span<const glm::dvec2> points) : first_(points[0]), last_(points[0]) {
    for (const glm::dvec2 point : points) {
        first_ = cross(first_, point) < 0 ? point : first_;
        last_ = cross(last_, point) > 0 ? point : last_;
    }
    for (const glm::dvec2 point : points) {  // half a turn and more has no ends
        all_ = all_ || cross(first_, point) < 0 || cross(last_, point) > 0 ||
               !(glm::dot(first_, point) > 0 || glm::dot(last_, point) > 0);
    }
    const double a = glm::length(first_), b = glm::length(last_);
    constexpr double kNear = 1e-3;  // m; nearer, rounding turns the direction
    all_ = all_ || !(a > kNear) || !(b > kNear);
    first_ /= a;
    last_ /= b;
}

bool Wedge::misses(std::span<const glm::dvec2> corners) const {
    constexpr double kSlack = 1e-9;  // sine; whether it touches is for others to say
    if (all_) {
        return false;
    }
    const auto slack = [](glm::dvec2 corner) {
        return kSlack * (std::abs(corner.x) + std::abs(corner.y));
    };
    return std::all_of(corners.begin(), corners.end(),
                       [&](glm::dvec2 c) { return cross(first_, c) < -slack(c); }) ||
           std::all_of(corners.begin(), corners.end(),
                       [&](glm::dvec2 c) { return cross(last_, c) > slack(c); });
}

GroupSight::GroupSight(const Occluders& occluders, const WindowGroup& group, Emitter emitter,
                       const AlongRay& along, const RayPart& part,
                       std::vector<std::uint32_t>& blockers)
    : occluders_(occluders),
      group_(group),
      along_(along),
      begin_(along.ray().at(part.begin)),
      end_(along.ray().at(part.end)) {
    const auto known = std::find_if(blockers.begin(), blockers.end(), [&](std::uint32_t face) {
        return isBlockedBy(occluders_.face(face));
    });
    hidden_ = known != blockers.end();
    if (hidden_) {
        std::rotate(blockers.begin(), known, known + 1);
        return;
    }
    findFaces(emitter);
    const auto found = std::find_if(faces_.begin(), faces_.end(), [&](std::uint32_t face) {
        return isBlockedBy(occluders_.face(face));
    });
    hidden_ = found != faces_.end();
    if (hidden_) {
        blockers.insert(blockers.begin(), *found);
        blockers.resize(std::min(blockers.size(), kKeptBlockers));
    }
}

// Where every way from a corner to an end crosses the face, so does every way between
// their hulls: it crosses the face's plane within the hull of those crossings.
bool GroupSight::isBlockedBy(std::span<const glm::dvec3> face) const {
    const glm::dvec3 normal = areaVector(face);
    for (const glm::dvec3 corner : group_.corner) {
        if (!crosses(face, normal, corner, begin_) || !crosses(face, normal, corner, end_)) {
            return false;
        }
    }
    // The wall of some of the windows may not be that of others.
    const auto isOther = [&](glm::dvec3 corner) {
        const double place = glm::dot(group_.normal, corner);
        return place > group_.highest + kPaneOnWall || place < group_.lowest - kPaneOnWall;
    };
    const auto isBehind = [&](glm::dvec3 corner) {
        return glm::dot(group_.normal, corner) <= group_.lowest;
    };
    return group_.normal == glm::dvec3(0) || std::any_of(face.begin(), face.end(), isOther) ||
           std::all_of(face.begin(), face.end(), isBehind);
}

void GroupSight::findFaces(Emitter emitter) {
    const bool frontOnly = emitter != Emitter::isotropic && group_.normal != glm::dvec3(0);
    firstAcross_.push_back(0);
    for (const std::uint32_t index : occluders_.between(group_.corner, begin_, end_)) {
        const auto face = occluders_.face(index);
        const auto isBehind = [&](glm::dvec3 corner) {
            return glm::dot(group_.normal, corner) <= group_.lowest;
        };
        if (frontOnly && std::all_of(face.begin(), face.end(), isBehind)) {
            continue;
        }
        faces_.push_back(index);
        for (const glm::dvec3 corner : face) {
            across_.push_back(along_.across(corner));
        }
        firstAcross_.push_back(std::uint32_t(across_.size()));
    }
}

Hiders GroupSight::hidersOf(const LitWindow& window, Emitter emitter) const {
    std::vector<glm::dvec2> corners;
    if (window.isPane(emitter)) {
        for (const glm::dvec3 corner : window.corners()) {
            corners.push_back(along_.across(corner));
        }
    } else {
        corners.push_back(along_.across(window.centre));
    }
    const Wedge wedge(corners);
    Hiders hiders;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        const std::span<const glm::dvec2> across(across_.data() + firstAcross_[i],
                                                 across_.data() + firstAcross_[i + 1]);
        if (!wedge.misses(across)) {
            hiders.addHiding(occluders_.face(faces_[i]), window, emitter);
        }
    }
    return hiders;
}

}  // namespace nightcity
