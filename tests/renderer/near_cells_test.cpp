// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which windows have near parts that rays integrate, against all cells of the lattice one by one.
#include "passes/near_cells.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "passes/near_panes.h"
#include "scene_builder.h"

namespace nightcity {
namespace {

constexpr float kRadius = 4;  // m
const vec3 kEye(10, 20, 2);

// A street that leads from the eye to bricks of every scale; nodes are 1 m apart in the smallest.
FarLayout street(std::uint64_t bricks) {
    const std::vector<FarMedium> media{{vec3(0), 0.02f, vec3(900, 40, 20), 0.01f}};
    FarDetail detail;
    detail.nodes.origin = vec3(-0.5f);
    detail.nodes.spacing = 1;
    detail.eyes = {&kEye, 1};
    detail.mostBricks = bricks;
    return layoutFarField(media, detail);
}

// m, to the nearest cell whose brick does not hold the near parts.
double distanceToRayBrick(const FarLayout& layout, const vec3& place) {
    double nearest = INFINITY;
    std::size_t i = 0;
    for (uint z = 0; z < layout.counts.z; ++z) {
        for (uint y = 0; y < layout.counts.y; ++y) {
            for (uint x = 0; x < layout.counts.x; ++x, ++i) {
                const uint word = layout.index[i];
                if (word == kNone ||
                    word >> kScaleShift >= blurredScale(kRadius, layout.cellSide / kBrickSteps)) {
                    continue;
                }
                const vec3 lo = layout.origin + layout.cellSide * vec3(x, y, z);
                const vec3 foot = glm::clamp(place, lo, lo + layout.cellSide);
                nearest = std::min(nearest, double(glm::distance(place, foot)));
            }
        }
    }
    return nearest;
}

TEST(NearCells, HoldTheWindowsThatReachABrickWithoutNearParts) {
    const FarLayout layout = street(60);
    const NearCells cells(layout, kRadius);
    // What the lattice may tell apart: as many cells as the radius needs, and the window's own.
    const double blunt =
        std::sqrt(3.0) * layout.cellSide * (std::ceil(kRadius / layout.cellSide) + 1);
    std::mt19937 random(7);
    const auto between = [&](float lo, float hi) {
        return std::uniform_real_distribution<float>(lo, hi)(random);
    };
    int reaching = 0, apart = 0;
    for (int i = 0; i < 8000; ++i) {
        const vec3 place(between(-20, 920), between(-20, 60), between(-20, 40));
        const double distance = distanceToRayBrick(layout, place);
        if (distance <= kRadius) {
            ++reaching;
            EXPECT_TRUE(cells.reaches(place)) << place.x << ' ' << place.y << ' ' << place.z;
        } else if (distance > blunt) {
            ++apart;
            EXPECT_FALSE(cells.reaches(place)) << place.x << ' ' << place.y << ' ' << place.z;
        }
    }
    EXPECT_GT(reaching, 100);
    EXPECT_GT(apart, 100);
}

TEST(NearPanes, AreOfTheWindowsThatReachTheCellsAlone) {
    const NearCells cells(street(60), kRadius);
    SceneBuilder city;
    city.addMediaBox({0, 0, 0}, {900, 40, 20}, 0.01f, 0.9f);
    city.addCamera("eye", kEye, {900, 20, 2}, 60);
    const vec3 far(880, 20, 5), near = kEye;
    for (const vec3& centre : {far, near, far, near + vec3(3, 0, 0)}) {
        city.addWindow(centre, {0, 0.5f, 0}, {0, 0, 0.5f}, 50, vec3(1), false);
    }
    const FlatScene scene = city.load();
    const NearPanes panes(scene, Emitter::pane, Visibility::none, kRadius);
    const NearField field = panes.build(cells);
    ASSERT_EQ(field.windows, (std::vector<uint>{1, 3}));
    ASSERT_EQ(field.panes.size(), 2u);
    EXPECT_EQ(field.panes[1].centre, near + vec3(3, 0, 0));
    std::vector<uint> items;
    for (const BoxNode& node : field.tree) {
        if (node.item != kNone) {
            items.push_back(node.item);
        }
    }
    std::ranges::sort(items);
    EXPECT_EQ(items, (std::vector<uint>{0, 1}));
}

TEST(NearCells, HoldNothingWithoutHaze) {
    EXPECT_FALSE(NearCells(FarLayout(), kRadius).reaches(vec3(0)));
}

}  // namespace
}  // namespace nightcity
