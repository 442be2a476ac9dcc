// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/shadow_intervals.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/convex_faces.h"

namespace nightcity {

namespace {

constexpr double kSliver = 1e-12;     // fraction of the stretch
constexpr double kNearApex = 1e-9;    // fraction of the way from the apex to the stretch

// The two ends of the chord in which the plane cuts a face, in weights. A corner
// in the plane counts as above it, alike for every face that shares it, and an end
// is computed from above to below: neighbours get the same numbers.
std::optional<std::pair<glm::dvec2, glm::dvec2>> chord(const ViewTriangle& view,
                                                       std::span<const glm::dvec3> face) {
    glm::dvec2 ends[2];
    int found = 0;
    glm::dvec3 last = face.back();
    double lastSide = view.side(last);
    for (const glm::dvec3 corner : face) {
        const double side = view.side(corner);
        if ((side >= 0) != (lastSide >= 0) && found < 2) {
            const bool risen = side >= 0;
            const glm::dvec3 above = risen ? corner : last;
            const glm::dvec3 below = risen ? last : corner;
            const double up = risen ? side : lastSide;
            const double down = risen ? lastSide : side;
            ends[found++] = view.weights(above + (below - above) * (up / (up - down)));
        }
        last = corner;
        lastSide = side;
    }
    if (found < 2) {
        return std::nullopt;
    }
    return std::pair{ends[0], ends[1]};
}

// Cuts [first, second] to the part of a segment where a linear quantity that runs
// from `atZero` to `atOne` is not negative.
void keepPositive(double atZero, double atOne, double& first, double& second) {
    if (atZero < 0 && atOne < 0) {
        second = -1;
    } else if (atZero < 0) {
        first = std::max(first, atZero / (atZero - atOne));
    } else if (atOne < 0) {
        second = std::min(second, atZero / (atZero - atOne));
    }
}

// The fractions that the part [first, second] of a chord from a to b covers.
Interval fractions(glm::dvec2 a, glm::dvec2 b, double first, double second) {
    if (!(first < second)) {
        return {};
    }
    const double p = stretchFraction(a + (b - a) * first);
    const double q = stretchFraction(a + (b - a) * second);
    return {std::clamp(std::min(p, q), 0.0, 1.0), std::clamp(std::max(p, q), 0.0, 1.0)};
}

}  // namespace

Interval shadow(const ViewTriangle& view, std::span<const glm::dvec3> face) {
    const auto ends = chord(view, face);
    if (!ends) {
        return {};
    }
    const auto [a, b] = *ends;
    double first = 0, second = 1;
    keepPositive(a.x, b.x, first, second);
    keepPositive(a.y, b.y, first, second);
    keepPositive(a.x + a.y - kNearApex, b.x + b.y - kNearApex, first, second);
    keepPositive(1 - a.x - a.y, 1 - b.x - b.y, first, second);
    return fractions(a, b, first, second);
}

Interval passage(const ViewTriangle& view, std::span<const glm::dvec3> face) {
    const auto ends = chord(view, face);
    if (!ends) {
        return {};
    }
    const auto [a, b] = *ends;
    double first = 0, second = 1;
    keepPositive(-a.x, -b.x, first, second);
    keepPositive(-a.y, -b.y, first, second);
    keepPositive(-a.x - a.y - kNearApex, -b.x - b.y - kNearApex, first, second);
    return fractions(a, b, first, second);
}

bool blocksLine(const ViewTriangle& view, std::span<const glm::dvec3> face) {
    const bool beginNearer =
        glm::dot(view.toBegin(), view.toBegin()) <= glm::dot(view.toEnd(), view.toEnd());
    const glm::dvec3 way = beginNearer ? view.toBegin() : view.toEnd();
    const glm::dvec3 normal = areaVector(face);
    const double along = glm::dot(way, normal);
    if (along == 0) {
        return false;
    }
    const double part = glm::dot(face[0] - view.apex(), normal) / along;
    if (!(part > kNearApex) || !(part < 1)) {
        return false;
    }
    const glm::dvec3 hit = view.apex() + part * way;
    for (std::size_t i = 0; i < face.size(); ++i) {
        const glm::dvec3 next = face[(i + 1) % face.size()];
        if (glm::dot(glm::cross(next - face[i], hit - face[i]), normal) < 0) {
            return false;
        }
    }
    return true;
}

std::vector<Interval> unshadowed(std::vector<Interval>& shadows) {
    std::sort(shadows.begin(), shadows.end(),
              [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
    std::vector<Interval> open;
    double reached = 0;
    for (const Interval& hidden : shadows) {
        if (hidden.begin > reached + kSliver) {
            open.push_back({reached, hidden.begin});
        }
        reached = std::max(reached, hidden.end);
    }
    if (reached < 1 - kSliver) {
        open.push_back({reached, 1});
    }
    return open;
}

}  // namespace nightcity
