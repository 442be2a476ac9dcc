// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/box_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace nightcity {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kLeafBoxes = 4;  // that one node holds side by side

float atMost(double value) {
    const auto nearest = static_cast<float>(value);
    return nearest <= value ? nearest : std::nextafter(nearest, -kInfinity);
}

float atLeast(double value) {
    const auto nearest = static_cast<float>(value);
    return nearest >= value ? nearest : std::nextafter(nearest, kInfinity);
}

// Of the tree over so many boxes: exactly, for a large city's would be copied as it grows.
std::size_t nodesFor(std::size_t boxes, std::map<std::size_t, std::size_t>& known) {
    if (boxes <= kLeafBoxes) {
        return boxes == 1 ? 1 : boxes + 1;
    }
    const auto found = known.find(boxes);  // a level has parts of two sizes at most
    if (found != known.end()) {
        return found->second;
    }
    const std::size_t half = boxes / 2;
    const std::size_t nodes = 1 + nodesFor(half, known) + nodesFor(boxes - half, known);
    known.emplace(boxes, nodes);
    return nodes;
}

class Builder {
public:
    Builder(std::size_t count, const std::function<Bounds(std::uint32_t)>& boundsOf)
        : boundsOf_(boundsOf), order_(count) {
        std::iota(order_.begin(), order_.end(), 0u);
        middles_.reserve(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const Bounds bounds = boundsOf(i);
            middles_.push_back(bounds.lo + bounds.hi);
        }
        std::map<std::size_t, std::size_t> known;
        nodes_.reserve(nodesFor(count, known));
    }

    std::vector<BoxNode> build() {
        split(order_);
        return std::move(nodes_);
    }

private:
    // Halves at the median centre of the longest axis: the depth is the logarithm of the number of
    // boxes, whatever their shapes.
    void split(std::span<std::uint32_t> part) {
        if (part.size() == 1) {
            addLeaf(part.front());
            return;
        }
        const std::size_t node = nodes_.size();
        nodes_.push_back({vec3(kInfinity), 0, vec3(-kInfinity), kNone});
        if (part.size() <= kLeafBoxes) {
            std::for_each(part.begin(), part.end(), [&](std::uint32_t i) { addLeaf(i); });
        } else {
            const std::size_t half = part.size() / 2;
            const int axis = longestAxis(part);
            std::nth_element(part.begin(), part.begin() + std::ptrdiff_t(half), part.end(),
                             [&](std::uint32_t a, std::uint32_t b) {
                                 return middles_[a][axis] < middles_[b][axis];
                             });
            split(part.first(half));
            split(part.subspan(half));
        }
        close(node);
    }

    int longestAxis(std::span<const std::uint32_t> part) const {
        Bounds middles;
        for (const std::uint32_t i : part) {
            middles.add(middles_[i]);
        }
        const glm::dvec3 size = middles.hi - middles.lo;
        return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    }

    void addLeaf(std::uint32_t box) {
        const Bounds bounds = boundsOf_(box);
        nodes_.push_back({{atMost(bounds.lo.x), atMost(bounds.lo.y), atMost(bounds.lo.z)},
                          std::uint32_t(nodes_.size() + 1),
                          {atLeast(bounds.hi.x), atLeast(bounds.hi.y), atLeast(bounds.hi.z)},
                          box});
    }

    // Its children are the nodes that follow, each where the one before is skipped to.
    void close(std::size_t index) {
        BoxNode& node = nodes_[index];
        for (std::size_t child = index + 1; child < nodes_.size(); child = nodes_[child].next) {
            node.lo = glm::min(node.lo, nodes_[child].lo);
            node.hi = glm::max(node.hi, nodes_[child].hi);
        }
        node.next = std::uint32_t(nodes_.size());
    }

    const std::function<Bounds(std::uint32_t)>& boundsOf_;
    std::vector<std::uint32_t> order_;
    std::vector<glm::dvec3> middles_;  // twice the centres
    std::vector<BoxNode> nodes_;
};

}  // namespace

std::vector<BoxNode> buildBoxNodes(std::size_t count,
                                   const std::function<Bounds(std::uint32_t)>& boundsOf) {
    return count == 0 ? std::vector<BoxNode>() : Builder(count, boundsOf).build();
}

std::vector<BoxNode> buildBoxNodes(std::span<const Bounds> boxes) {
    return buildBoxNodes(boxes.size(), [&](std::uint32_t i) { return boxes[i]; });
}

}  // namespace nightcity
