// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/box_tree.h"

#include <numeric>

namespace nightcity {

namespace {

constexpr std::uint32_t kLeafBoxes = 4;

}  // namespace

std::pair<double, double> slabs(const Bounds& bounds, glm::dvec3 origin, glm::dvec3 direction) {
    double enter = 0;
    double leave = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) {
            if (origin[axis] < bounds.lo[axis] || origin[axis] > bounds.hi[axis]) {
                return {1, 0};
            }
            continue;
        }
        const double a = (bounds.lo[axis] - origin[axis]) / direction[axis];
        const double b = (bounds.hi[axis] - origin[axis]) / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return {enter, leave};
}

BoxTree::BoxTree(std::vector<Bounds> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!boxes_.empty()) {
        nodes_.reserve(boxes_.size());
        nodes_.emplace_back();
        split(0, 0, std::uint32_t(boxes_.size()));
    }
}

// Halves at the median centre of the longest axis: the depth is the logarithm of
// the number of boxes, whatever their shapes.
void BoxTree::split(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
    Bounds bounds, centres;
    for (std::uint32_t i = first; i < first + count; ++i) {
        const Bounds& box = boxes_[order_[i]];
        bounds.add(box);
        centres.add(box.lo + box.hi);
    }
    nodes_[node].bounds = bounds;
    if (count <= kLeafBoxes) {
        nodes_[node].first = first;
        nodes_[node].count = count;
        return;
    }
    const glm::dvec3 size = centres.hi - centres.lo;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto begin = order_.begin() + first;
    const std::uint32_t half = count / 2;
    std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
        return boxes_[a].lo[axis] + boxes_[a].hi[axis] < boxes_[b].lo[axis] + boxes_[b].hi[axis];
    });
    const std::uint32_t left = std::uint32_t(nodes_.size());
    nodes_[node].first = left;
    nodes_.resize(nodes_.size() + 2);
    split(left, first, half);
    split(left + 1, first + half, count - half);
}

}  // namespace nightcity
