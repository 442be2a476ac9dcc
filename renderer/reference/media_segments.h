// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The parts of a ray inside media.
#pragma once

#include <vector>

#include "reference/ray.h"
#include "scene/box_tree.h"
#include "scene/flat_scene.h"

namespace nightcity {

struct Segment {
    std::uint32_t box;  // into FlatScene::mediaBoxes
    double begin;       // m along the ray, 0 or more
    double end;         // greater than begin
};

class MediaSegments {
public:
    explicit MediaSegments(const FlatScene& scene);  // the scene must outlive it

    // In the order of entry, cut at `farthest` (m). A point belongs to a box where
    // lo <= x < hi: a ray along a common face lies in one box, not two.
    std::vector<Segment> along(const Ray& ray, double farthest) const;

private:
    const FlatScene& scene_;
    BoxTree tree_;
};

}  // namespace nightcity
