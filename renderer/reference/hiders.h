// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What may hide one window: convex faces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "reference/emitters.h"

namespace nightcity {

// Whether a face is a wall that a window lies on: it reaches in front of the window's
// plane, and nowhere further than kPaneOnWall from it.
bool isOwnWall(std::span<const glm::dvec3> face, const LitWindow& window);

class Hiders {
public:
    // A face, unless it is the window's own wall; only its part in front of a window
    // that shines to the front only.
    void addHiding(std::span<const glm::dvec3> convexFace, const LitWindow& window,
                   Emitter emitter);

    std::size_t size() const { return first_.size() - 1; }
    std::span<const glm::dvec3> operator[](std::size_t index) const {
        return {corners_.data() + first_[index], corners_.data() + first_[index + 1]};
    }

private:
    // Fewer than three corners: nothing.
    void add(std::span<const glm::dvec3> convexFace);

    std::vector<glm::dvec3> corners_;
    std::vector<std::uint32_t> first_{0};  // into corners_, one more than faces
};

// The part of a convex face where dot(normal, point) > least; may be empty.
std::vector<glm::dvec3> partAbove(std::span<const glm::dvec3> convexFace, glm::dvec3 normal,
                                  double least);

}  // namespace nightcity
