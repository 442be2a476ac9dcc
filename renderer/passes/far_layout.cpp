// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "passes/far_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "errors.h"

namespace nightcity {
namespace {

std::string megabytes(double bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.0f MB", std::ceil(bytes / 1e6));
    return text;
}

void checkMemory(double bricks, float spacing, std::uint64_t memoryBytes) {
    const double nodes = bricks * std::pow(double(kBrickCells) + 1, 3);
    const double bytes = nodes * double(kFarNodeBytes);
    if (bytes > double(memoryBytes) || nodes >= 4294967295.0) {
        throw DeviceError("the far field takes " + megabytes(bytes) + " at a node spacing of " +
                          std::to_string(spacing) + " m, more than the " +
                          megabytes(double(memoryBytes)) +
                          " that it may: allow a larger error, or render a smaller city");
    }
}

struct CellRange {
    uvec3 first, last;  // last is one of them
};

CellRange cellsOf(const FarLayout& layout, const FarMedium& medium) {
    const glm::dvec3 origin(layout.origin);
    const double side = layout.brickSide;
    const glm::dvec3 lo = (glm::dvec3(medium.lo) - origin) / side;
    const glm::dvec3 hi = (glm::dvec3(medium.hi) - origin) / side;
    const glm::dvec3 most = glm::dvec3(layout.counts) - 1.0;
    return {uvec3(glm::clamp(glm::floor(lo), glm::dvec3(0), most)),
            uvec3(glm::clamp(glm::ceil(hi) - 1.0, glm::dvec3(0), most))};
}

template <typename Visit>
void visitCells(const FarLayout& layout, const FarMedium& medium, Visit&& visit) {
    const CellRange range = cellsOf(layout, medium);
    for (uint z = range.first.z; z <= range.last.z; ++z) {
        for (uint y = range.first.y; y <= range.last.y; ++y) {
            for (uint x = range.first.x; x <= range.last.x; ++x) {
                visit((std::size_t{z} * layout.counts.y + y) * layout.counts.x + x);
            }
        }
    }
}

void placeLattice(FarLayout& layout, std::span<const FarMedium> media, float spacing,
                  std::uint64_t memoryBytes) {
    vec3 lo = media.front().lo, hi = media.front().hi;
    for (const FarMedium& medium : media) {
        lo = glm::min(lo, medium.lo);
        hi = glm::max(hi, medium.hi);
    }
    layout.origin = lo - 0.5f * spacing;
    const glm::dvec3 cells = glm::ceil((glm::dvec3(hi) - glm::dvec3(layout.origin)) /
                                       double(layout.brickSide));
    // The index alone must not pass the memory either.
    if (cells.x * cells.y * cells.z * 4 > double(memoryBytes)) {
        checkMemory(cells.x * cells.y * cells.z, spacing, memoryBytes);
    }
    layout.counts = uvec3(cells);
}

}  // namespace

FarLayout layoutFarField(std::span<const FarMedium> media, float spacing,
                         std::uint64_t memoryBytes) {
    FarLayout layout;
    layout.brickSide = spacing * float(kBrickCells);
    if (media.empty()) {
        return layout;
    }
    placeLattice(layout, media, spacing, memoryBytes);
    std::vector<uint> mediaOf(std::size_t{layout.counts.x} * layout.counts.y * layout.counts.z);
    for (const FarMedium& medium : media) {
        visitCells(layout, medium, [&](std::size_t cell) { ++mediaOf[cell]; });
    }
    const auto bricks = std::count_if(mediaOf.begin(), mediaOf.end(), [](uint n) { return n > 0; });
    checkMemory(double(bricks), spacing, memoryBytes);
    layout.index.assign(mediaOf.size(), ~0u);
    uint listed = 0;
    for (std::size_t cell = 0; cell < mediaOf.size(); ++cell) {
        if (mediaOf[cell] > 0) {
            layout.index[cell] = uint(layout.bricks.size());
            layout.bricks.push_back({uint(layout.nodes), 0, listed, 0});
            const std::size_t row = cell / layout.counts.x;
            layout.cells.emplace_back(cell % layout.counts.x, row % layout.counts.y,
                                      row / layout.counts.y);
            layout.nodes += std::uint64_t{kBrickCells + 1} * (kBrickCells + 1) * (kBrickCells + 1);
            listed += mediaOf[cell];
        }
    }
    layout.mediumList.resize(listed);
    for (uint i = 0; i < media.size(); ++i) {
        visitCells(layout, media[i], [&](std::size_t cell) {
            FarBrick& brick = layout.bricks[layout.index[cell]];
            layout.mediumList[brick.firstMedium + brick.mediumCount++] = i;
        });
    }
    return layout;
}

}  // namespace nightcity
