// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/haze_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace nightcity {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Cell {
    vec3 lo{-kInfinity};
    vec3 hi{kInfinity};
};

struct Cut {
    int axis = -1;  // none
    float plane = 0;
    std::size_t cost = std::numeric_limits<std::size_t>::max();
};

class Builder {
public:
    explicit Builder(std::span<const FarMedium> media) : media_(media) {}

    std::vector<HazeNode> build() {
        std::vector<std::uint32_t> all(media_.size());
        std::iota(all.begin(), all.end(), 0u);
        split(all, {});
        return std::move(nodes_);
    }

private:
    void split(const std::vector<std::uint32_t>& items, const Cell& cell) {
        const Cut cut = items.size() > 1 ? bestCut(items, cell) : Cut{};
        const std::size_t node = nodes_.size();
        if (cut.axis < 0) {
            nodes_.push_back({0, kHazeLeaf, items.empty() ? kNone : items.front()});
            return;
        }
        nodes_.push_back({cut.plane, std::uint32_t(cut.axis), 0});
        std::vector<std::uint32_t> below, above;
        for (const std::uint32_t item : items) {
            if (media_[item].lo[cut.axis] < cut.plane) {
                below.push_back(item);
            }
            if (media_[item].hi[cut.axis] > cut.plane) {
                above.push_back(item);
            }
        }
        Cell lower = cell, upper = cell;
        lower.hi[cut.axis] = upper.lo[cut.axis] = cut.plane;
        split(below, lower);
        nodes_[node].item = std::uint32_t(nodes_.size());
        split(above, upper);
    }

    // Of the faces inside the cell the one that leaves the least on its fuller side, counting
    // what it cuts twice.
    Cut bestCut(const std::vector<std::uint32_t>& items, const Cell& cell) const {
        Cut best;
        std::vector<float> lows, highs;
        for (int axis = 0; axis < 3; ++axis) {
            lows.clear();
            highs.clear();
            for (const std::uint32_t item : items) {
                lows.push_back(media_[item].lo[axis]);
                highs.push_back(media_[item].hi[axis]);
            }
            std::sort(lows.begin(), lows.end());
            std::sort(highs.begin(), highs.end());
            const auto consider = [&](float plane) {
                if (!(cell.lo[axis] < plane && plane < cell.hi[axis])) {
                    return;
                }
                const auto below = std::size_t(std::lower_bound(lows.begin(), lows.end(), plane) -
                                               lows.begin());
                const auto above = std::size_t(
                    highs.end() - std::upper_bound(highs.begin(), highs.end(), plane));
                const std::size_t cost = std::max(below, above) + (below + above);
                if (cost < best.cost) {
                    best = {axis, plane, cost};
                }
            };
            std::for_each(lows.begin(), lows.end(), consider);
            std::for_each(highs.begin(), highs.end(), consider);
        }
        return best;
    }

    std::span<const FarMedium> media_;
    std::vector<HazeNode> nodes_;
};

}  // namespace

std::vector<HazeNode> buildHazeTree(std::span<const FarMedium> media) {
    return media.empty() ? std::vector<HazeNode>() : Builder(media).build();
}

}  // namespace nightcity
