// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The tree that paths walk through haze.
#include "passes/haze_tree.h"

#include <random>

#include <gtest/gtest.h>

namespace nightcity {
namespace {

bool contains(const FarMedium& medium, vec3 point) {
    return glm::all(glm::lessThanEqual(medium.lo, point)) &&
           glm::all(glm::lessThan(point, medium.hi));
}

// The medium about a point, by the tree.
std::uint32_t mediumAt(const std::vector<HazeNode>& nodes, std::span<const FarMedium> media,
                       vec3 point) {
    std::uint32_t index = 0;
    while (nodes[index].axis != kHazeLeaf) {
        const HazeNode& node = nodes[index];
        index = point[int(node.axis)] < node.plane ? index + 1 : node.item;
    }
    const std::uint32_t item = nodes[index].item;
    return item != kNone && contains(media[item], point) ? item : kNone;
}

// Boxes of a lattice without every fifth, of uneven sides.
std::vector<FarMedium> unevenLattice() {
    std::vector<FarMedium> media;
    for (int i = 0; i < 6 * 5 * 4; ++i) {
        const vec3 cell(i % 6, i / 6 % 5, i / 30);
        if (i % 5 != 3) {
            const vec3 next = cell + 1.0f;
            media.push_back({cell * cell, 0.01f * float(i + 1), next * next, 0.01f});
        }
    }
    return media;
}

TEST(HazeTree, FindsTheBoxAboutEveryPoint) {
    const std::vector<FarMedium> media = unevenLattice();
    const std::vector<HazeNode> nodes = buildHazeTree(media);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-2, 40);
    int inside = 0;
    for (int i = 0; i < 20000; ++i) {
        const vec3 point(place(random), place(random), place(random) / 2);
        std::uint32_t expected = kNone;
        for (std::uint32_t k = 0; k < media.size(); ++k) {
            expected = contains(media[k], point) ? k : expected;
        }
        inside += expected != kNone;
        EXPECT_EQ(mediumAt(nodes, media, point), expected);
    }
    EXPECT_GT(inside, 1000);
}

// Fillers of buildings may reach into boxes: there the first counts, and once.
TEST(HazeTree, OverlapsEndInOneOfTheTwo) {
    const std::vector<FarMedium> media{{vec3(0), 0.01f, vec3(10), 0.01f},
                                       {vec3(5), 0.01f, vec3(15), 0.01f}};
    const std::vector<HazeNode> nodes = buildHazeTree(media);
    EXPECT_EQ(mediumAt(nodes, media, vec3(2)), 0u);
    EXPECT_EQ(mediumAt(nodes, media, vec3(7)), 0u);
    EXPECT_EQ(mediumAt(nodes, media, vec3(12)), 1u);
    EXPECT_EQ(mediumAt(nodes, media, vec3(2, 12, 2)), kNone);
}

TEST(HazeTree, NothingMakesNoTree) {
    EXPECT_TRUE(buildHazeTree({}).empty());
}

}  // namespace
}  // namespace nightcity
