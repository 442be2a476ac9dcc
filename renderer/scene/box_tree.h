// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which axis-aligned boxes a box overlaps or a ray meets, without asking all of
// them: a binary tree of bounds in double precision.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "scene.h"

namespace nightcity {

struct Bounds {
    glm::dvec3 lo{std::numeric_limits<double>::infinity()};
    glm::dvec3 hi{-std::numeric_limits<double>::infinity()};

    void add(glm::dvec3 point) {
        lo = glm::min(lo, point);
        hi = glm::max(hi, point);
    }
    void add(const Bounds& other) {
        lo = glm::min(lo, other.lo);
        hi = glm::max(hi, other.hi);
    }
    bool touches(const Bounds& other) const {  // common faces count
        return glm::all(glm::lessThanEqual(lo, other.hi)) &&
               glm::all(glm::lessThanEqual(other.lo, hi));
    }
};

// The part [first, second] of a ray (t >= 0) between the planes of the bounds,
// first > second where it misses. A ray within the plane of a face meets it.
std::pair<double, double> slabs(const Bounds& bounds, glm::dvec3 origin, glm::dvec3 direction);

class BoxTree {
public:
    explicit BoxTree(std::vector<Bounds> boxes);

    const Bounds& box(std::uint32_t index) const { return boxes_[index]; }

    // visit(index) for every box that touches the query.
    template <typename Visit>
    void visitTouching(const Bounds& query, Visit&& visit) const {
        visitWhere([&](const Bounds& bounds) { return bounds.touches(query); }, visit);
    }

    // visit(index) for every box that the ray meets at t in [0, farthest()], in no
    // order; farthest may shrink on the way.
    template <typename Farthest, typename Visit>
    void visitAlong(glm::dvec3 origin, glm::dvec3 direction, Farthest&& farthest,
                    Visit&& visit) const {
        visitWhere(
            [&](const Bounds& bounds) {
                const auto [enter, leave] = slabs(bounds, origin, direction);
                return enter <= leave && enter <= farthest();
            },
            visit);
    }

    // visit(index) for every box that enter(bounds) accepts, in no order. enter must
    // accept whatever holds a box that it accepts.
    template <typename Enter, typename Visit>
    void visitWhere(Enter&& enter, Visit&& visit) const {
        std::vector<std::uint32_t> open;
        if (!nodes_.empty()) {
            open.push_back(0);
        }
        while (!open.empty()) {
            const Node& node = nodes_[open.back()];
            open.pop_back();
            if (!enter(node.bounds)) {
                continue;
            }
            if (node.count == 0) {
                open.push_back(node.first + 1);
                open.push_back(node.first);
                continue;
            }
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                if (enter(boxes_[order_[i]])) {
                    visit(order_[i]);
                }
            }
        }
    }

private:
    struct Node {
        Bounds bounds;
        std::uint32_t first = 0;   // leaf: into order_; else the left child, right child at + 1
        std::uint32_t count = 0;   // 0: not a leaf
    };

    void split(std::uint32_t node, std::uint32_t first, std::uint32_t count);

    std::vector<Bounds> boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace nightcity
