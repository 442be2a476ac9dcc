// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which convex faces may hide a stretch. The ground is none of them: a ray above it
// ends on it, and what shines from below never reaches the ray.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scene/box_tree.h"
#include "scene/convex_faces.h"
#include "scene/flat_scene.h"

namespace nightcity {

class Occluders {
public:
    explicit Occluders(const FlatScene& scene);

    std::span<const glm::dvec3> face(std::uint32_t index) const { return faces_.face(index); }
    std::size_t size() const { return faces_.size(); }

    // Indices, rising, of every face that may hide part of the stretch from a source
    // as HullRegion has it; some of them may hide nothing.
    std::vector<std::uint32_t> between(std::span<const glm::dvec3> source, glm::dvec3 begin,
                                       glm::dvec3 end) const;

    std::optional<double> groundHeight() const { return groundHeight_; }  // m

    // Whether the ground lies between two points.
    bool groundBetween(glm::dvec3 a, glm::dvec3 b) const {
        return groundHeight_ && (a.z < *groundHeight_) != (b.z < *groundHeight_);
    }

private:
    ConvexFaces faces_;
    BoxTree tree_;
    std::optional<double> groundHeight_;   // m
};

}  // namespace nightcity
