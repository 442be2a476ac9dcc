// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Opaque geometry as convex faces: neighbouring triangles of one plane are one
// face, so that a wall's shadow has no seam.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scene/box_tree.h"
#include "scene/flat_scene.h"

namespace nightcity {

class ConvexFaces {
public:
    // Joins a triangle to the face before it where they share an edge, lie in one plane
    // (1 micrometre) and the union is convex. Every triangle is in one face.
    explicit ConvexFaces(const FlatScene& scene);

    // Corners in order, counter-clockwise seen from outside, at least three; a view into
    // this object. They are the scene's positions to the bit.
    std::span<const glm::dvec3> face(std::uint32_t index) const {
        return {corners_.data() + first_[index], corners_.data() + first_[index + 1]};
    }
    std::size_t size() const { return first_.size() - 1; }
    // The face of each triangle.
    std::span<const std::uint32_t> ofTriangle() const { return ofTriangle_; }
    // Of each face, m.
    std::vector<Bounds> bounds() const;

private:
    std::vector<glm::dvec3> corners_;
    std::vector<std::uint32_t> first_{0};  // into corners_, one more than faces
    std::vector<std::uint32_t> ofTriangle_;
};

// Twice the area times the unit normal, outward, of a face's corners.
glm::dvec3 areaVector(std::span<const glm::dvec3> face);

}  // namespace nightcity
