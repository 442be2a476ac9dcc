// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the bricks of the far field lie and how large they are.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "errors.h"
#include "passes/far_layout.h"

namespace nightcity {
namespace {

// A street of 400 m, and a thin layer over one end of it.
const std::vector<FarMedium> kMedia{{vec3(0), 0.02f, vec3(400, 40, 20), 0.01f},
                                    {vec3(0, 0, 20), 0.01f, vec3(100, 40, 30), 0.01f}};
const vec3 kEye(10, 20, 2);

FarDetail uniform() {
    FarDetail detail;
    detail.nodes.origin = vec3(-0.5f);
    detail.nodes.spacing = 1;
    return detail;
}

FarDetail about(const vec3& eye, std::uint64_t bricks) {
    FarDetail detail = uniform();
    detail.eyes = {&eye, 1};
    detail.mostBricks = bricks;
    return detail;
}

// kNone where no brick holds the cell.
uint brickOf(const FarLayout& layout, uvec3 cell) {
    const uint word =
        layout.index[(std::size_t{cell.z} * layout.counts.y + cell.y) * layout.counts.x + cell.x];
    if (word == kNone) {
        return kNone;
    }
    const uint brick = word & ((1u << kScaleShift) - 1);
    EXPECT_EQ(word >> kScaleShift, layout.bricks.at(brick).scale);
    return brick;
}

vec3 centreOf(const FarLayout& layout, const FarBrick& brick) {
    return layout.origin +
           layout.cellSide * (vec3(brick.cell) + 0.5f * float(1u << brick.scale));
}

TEST(FarLayout, WithoutEyesAllBricksAreTheSmallest) {
    const FarLayout layout = layoutFarField(kMedia, uniform());
    EXPECT_EQ(layout.counts, uvec3(51, 6, 4));
    for (const FarBrick& brick : layout.bricks) {
        EXPECT_EQ(brick.scale, 0u);
    }
}

TEST(FarLayout, EveryHazyCellHasOneBrickAndOthersHaveNone) {
    const FarLayout layout = layoutFarField(kMedia, about(kEye, 200));
    std::vector<std::size_t> held(layout.bricks.size());
    for (uint z = 0; z < layout.counts.z; ++z) {
        for (uint y = 0; y < layout.counts.y; ++y) {
            for (uint x = 0; x < layout.counts.x; ++x) {
                const vec3 lo = layout.origin + layout.cellSide * vec3(x, y, z);
                const bool hazy = lo.z < 20 || lo.x < 100;
                const uint index = brickOf(layout, {x, y, z});
                if (index == kNone) {
                    EXPECT_FALSE(hazy);
                    continue;
                }
                const FarBrick& brick = layout.bricks.at(index);
                EXPECT_EQ(uvec3(x, y, z) >> brick.scale, brick.cell >> brick.scale);
                EXPECT_EQ((brick.cell >> brick.scale) << brick.scale, brick.cell);
                ++held[index];
            }
        }
    }
    EXPECT_EQ(std::count(held.begin(), held.end(), 0u), 0);
}

TEST(FarLayout, BricksGrowWithTheDistance) {
    const FarLayout layout = layoutFarField(kMedia, about(kEye, 200));
    EXPECT_LE(layout.bricks.size(), 200u);
    uint largest = 0;
    for (const FarBrick& brick : layout.bricks) {
        largest = std::max(largest, brick.scale);
        for (const FarBrick& other : layout.bricks) {
            const auto away = [&](const FarBrick& b) {
                return glm::length(centreOf(layout, b) - kEye);
            };
            const float sides = layout.cellSide * float((2u << brick.scale) + (2u << other.scale));
            if (away(other) > 2 * (away(brick) + sides)) {
                EXPECT_GE(other.scale, brick.scale);
            }
        }
    }
    EXPECT_GE(largest, 2u);
    EXPECT_EQ(layout.bricks[brickOf(layout, {1, 2, 0})].scale, 0u);
}

TEST(FarLayout, MoreBricksMakeItFiner) {
    const std::size_t few = layoutFarField(kMedia, about(kEye, 200)).bricks.size();
    const std::size_t more = layoutFarField(kMedia, about(kEye, 600)).bricks.size();
    EXPECT_GT(more, 2 * few);
    EXPECT_LE(more, 600u);
    EXPECT_EQ(layoutFarField(kMedia, about(kEye, 1u << 20)).bricks.size(),
              layoutFarField(kMedia, uniform()).bricks.size());
}

TEST(FarLayout, BricksNameTheMediaThatTheyOverlap) {
    const FarLayout layout = layoutFarField(kMedia, about(kEye, 200));
    for (const FarBrick& brick : layout.bricks) {
        const vec3 lo = layout.origin + layout.cellSide * vec3(brick.cell);
        const vec3 hi = lo + layout.cellSide * float(1u << brick.scale);
        std::vector<uint> expected;
        for (uint i = 0; i < kMedia.size(); ++i) {
            if (glm::all(glm::lessThan(lo, kMedia[i].hi)) &&
                glm::all(glm::lessThan(kMedia[i].lo, hi))) {
                expected.push_back(i);
            }
        }
        const auto first = layout.mediumList.begin() + brick.firstMedium;
        EXPECT_EQ(std::vector<uint>(first, first + brick.mediumCount), expected);
    }
}

TEST(FarLayout, TheMemoryMakesItCoarserOrIsRefusedWithTheFigure) {
    FarDetail detail = about(kEye, ~0u);
    const std::uint64_t all = layoutFarField(kMedia, detail).nodes() * kFarNodeBytes;
    detail.memoryBytes = all / 4;
    EXPECT_LE(layoutFarField(kMedia, detail).nodes() * kFarNodeBytes, all / 4);
    detail.memoryBytes = 100'000;
    try {
        layoutFarField(kMedia, detail);
        FAIL();
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find("far field takes"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("1 MB"), std::string::npos);
    }
}

}  // namespace
}  // namespace nightcity
