// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Opaque geometry as convex faces: neighbouring triangles of one plane are one
// face, so that a wall's shadow has no seam. The ground is none of them: a ray
// above it ends on it, and what shines from below never reaches the ray.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scene/box_tree.h"
#include "scene/flat_scene.h"

namespace nightcity {

class Occluders {
public:
    explicit Occluders(const FlatScene& scene);

    // Corners in order, at least three; a view into this object.
    std::span<const glm::dvec3> face(std::uint32_t index) const {
        return {corners_.data() + first_[index], corners_.data() + first_[index + 1]};
    }
    std::size_t size() const { return first_.size() - 1; }

    // Indices, rising, of every face that may hide part of the stretch from a point
    // within `radius` (m) of `point`; some of them may hide nothing.
    std::vector<std::uint32_t> between(glm::dvec3 point, double radius, glm::dvec3 begin,
                                       glm::dvec3 end) const;

    // Whether the ground lies between two points.
    bool groundBetween(glm::dvec3 a, glm::dvec3 b) const {
        return groundHeight_ && (a.z < *groundHeight_) != (b.z < *groundHeight_);
    }

private:
    void build(const FlatScene& scene);
    static std::vector<Bounds> boundsOf(const Occluders& faces);

    std::vector<glm::dvec3> corners_;
    std::vector<std::uint32_t> first_{0};  // into corners_, one more than faces
    std::optional<double> groundHeight_;   // m
    std::optional<BoxTree> tree_;
};

}  // namespace nightcity
