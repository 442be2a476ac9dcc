// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/hiders.h"

#include <algorithm>
#include <limits>

namespace nightcity {

namespace {

// Least and greatest height of a face in front of a window's plane, m.
struct Heights {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();

    Heights(std::span<const glm::dvec3> face, const LitWindow& window) {
        for (const glm::dvec3 corner : face) {
            const double height = glm::dot(window.normal, corner - window.centre);
            least = std::min(least, height);
            most = std::max(most, height);
        }
    }
    bool isOwnWall() const { return most > 0 && most <= kPaneOnWall && least >= -kPaneOnWall; }
};

}  // namespace

bool isOwnWall(std::span<const glm::dvec3> face, const LitWindow& window) {
    return !window.sphere && Heights(face, window).isOwnWall();
}

void Hiders::add(std::span<const glm::dvec3> convexFace) {
    if (convexFace.size() < 3) {
        return;
    }
    corners_.insert(corners_.end(), convexFace.begin(), convexFace.end());
    first_.push_back(std::uint32_t(corners_.size()));
}

void Hiders::addHiding(std::span<const glm::dvec3> convexFace, const LitWindow& window,
                       Emitter emitter) {
    const Heights heights(convexFace, window);
    const bool frontOnly = emitter != Emitter::isotropic && !window.sphere;
    if (!window.sphere && heights.isOwnWall()) {
        return;
    }
    if (frontOnly && heights.least < 0) {
        add(partAbove(convexFace, window.normal, glm::dot(window.normal, window.centre)));
    } else {
        add(convexFace);
    }
}

// Sutherland and Hodgman 1974.
std::vector<glm::dvec3> partAbove(std::span<const glm::dvec3> face, glm::dvec3 normal,
                                  double least) {
    std::vector<glm::dvec3> part;
    glm::dvec3 last = face.back();
    double lastHeight = glm::dot(normal, last) - least;
    for (const glm::dvec3 corner : face) {
        const double height = glm::dot(normal, corner) - least;
        if ((height > 0) != (lastHeight > 0)) {
            part.push_back(last + (corner - last) * (lastHeight / (lastHeight - height)));
        }
        if (height > 0) {
            part.push_back(corner);
        }
        last = corner;
        lastHeight = height;
    }
    return part;
}

}  // namespace nightcity
