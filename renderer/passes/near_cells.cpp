// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/near_cells.h"

#include <algorithm>
#include <cmath>

namespace nightcity {

NearCells::NearCells(const FarLayout& layout, float radius)
    : origin_(layout.origin),
      cellSide_(layout.cellSide),
      counts_(layout.counts),
      cells_(layout.index.size()) {
    const unsigned blurred = blurredScale(radius, layout.cellSide / float(kBrickSteps));
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const uint word = layout.index[i];
        cells_[i] = word != ~0u && word >> kScaleShift < blurred;
    }
    for (int axis = 0; axis < 3; ++axis) {
        widen(axis, int(std::ceil(radius / cellSide_)));
    }
}

// Each row along the axis by so many cells on both sides.
void NearCells::widen(int axis, int cells) {
    const std::vector<bool> narrow = cells_;
    const int count = counts_[axis];
    const std::size_t stride = axis == 0   ? 1
                               : axis == 1 ? std::size_t(counts_.x)
                                           : std::size_t(counts_.x) * std::size_t(counts_.y);
    for (std::size_t i = 0; i < narrow.size(); ++i) {
        if (!narrow[i]) {
            continue;
        }
        const int at = int(i / stride % std::size_t(count));
        for (int k = std::max(at - cells, 0); k <= std::min(at + cells, count - 1); ++k) {
            cells_[i + std::size_t(k - at) * stride] = true;
        }
    }
}

bool NearCells::reaches(vec3 centre) const {
    if (cells_.empty()) {
        return false;
    }
    // One outside the lattice is no nearer to a cell than the place on its side.
    const vec3 place = (centre - origin_) / cellSide_;
    const glm::ivec3 cell = glm::ivec3(glm::clamp(glm::floor(place), vec3(0), vec3(counts_ - 1)));
    return cells_[(std::size_t(cell.z) * std::size_t(counts_.y) + std::size_t(cell.y)) *
                      std::size_t(counts_.x) +
                  std::size_t(cell.x)];
}

}  // namespace nightcity
