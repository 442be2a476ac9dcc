// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The tree over the windows, and where it may end.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "passes/far_cut.h"
#include "passes/far_lights.h"
#include "transport/near_far_split.h"

namespace nightcity {
namespace {

constexpr float kNearRadius = 4;  // m
constexpr float kSpread = 0.15f;

// Facades of 5 x 4 windows that face each other over streets of 10 m, in 24 x 24 blocks.
std::vector<Window> cityWindows() {
    std::vector<Window> windows;
    for (int block = 0; block < 24 * 24; ++block) {
        const vec3 corner(float(block % 24) * 20, float(block / 24) * 20, 0);
        for (int i = 0; i < 40; ++i) {
            Window window{};
            const bool back = i % 2 == 1;
            window.centre = corner + vec3(2.0f * float(i / 2 % 4 + 1), back ? 10 : 0,
                                          5.0f * float(i / 8 + 1));
            window.halfU = vec3(back ? -0.6f : 0.6f, 0, 0);
            window.halfV = vec3(0, 0, 0.75f);
            window.power = 50;
            window.colour = vec3(1, 0.75f, 0.5f);
            windows.push_back(window);
        }
    }
    return windows;
}

class FarLightsCut : public ::testing::Test {
protected:
    FarLightsCut() : windows_(cityWindows()) {
        scene_.windows = windows_;
        FarDetail detail;
        detail.nodes.spacing = 1;
        detail.eyes = {&eye_, 1};
        detail.mostBricks = 300;
        layout_ = layoutFarField(media_, detail);
    }

    FarLights lights(float spread) const {
        return buildFarLights(scene_, media_, FarCut(layout_, {Emitter::pane, kNearRadius, spread}),
                              Emitter::pane);
    }

    // As howSeen of far_sight.comp has it.
    bool isSeenApart(const FarLight& light, const FarBrick& brick) const {
        const float half = 0.5f * layout_.cellSide * float(1u << brick.scale);
        const vec3 centre = layout_.origin + layout_.cellSide * vec3(brick.cell) + half;
        const float gap = glm::length(glm::max(glm::abs(light.centre - centre) - half, vec3(0)));
        const float reach = glm::length(light.reach);
        const float growth = std::max(1.0f, gap / (kFullSpread * kNearRadius)) *
                             float(1u << 2u * brick.scale);
        const float spread = std::min(kSpread * growth, std::max(kSpread, kLargestSpread));
        const float radius = splitRadius(kNearRadius, float(1u << brick.scale),
                                         brick.scale >= blurredScale(kNearRadius, 1));
        const bool isFar = reach <= spread * gap && gap >= radius + reach;
        if (light.coneCos < kClusterCos) {
            return true;
        }
        if (brick.scale == 0) {
            return !isFar || std::sqrt(3.0f) * half > spread * gap;
        }
        return !isFar && reach * kJoinedReach > half;
    }

    const std::vector<FarMedium> media_{{vec3(0), 0.01f, vec3(480, 480, 30), 0.009f}};
    const vec3 eye_{15, 15, 2};
    std::vector<Window> windows_;
    FlatScene scene_;
    FarLayout layout_;
};

TEST_F(FarLightsCut, OpensWhateverABrickLooksInto) {
    const FarLights all = lights(0);
    ASSERT_EQ(all.lights.size(), 2 * windows_.size() - 1);
    const FarCut cut(layout_, {Emitter::pane, kNearRadius, kSpread});
    std::size_t closed = 0;
    for (const FarLight& light : all.lights) {
        if (light.second == 0) {
            continue;
        }
        if (!cut.mayOpen(light)) {
            ++closed;
            EXPECT_TRUE(std::none_of(layout_.bricks.begin(), layout_.bricks.end(),
                                     [&](const FarBrick& b) { return isSeenApart(light, b); }));
        }
    }
    EXPECT_GT(closed, windows_.size() / 2);
}

TEST_F(FarLightsCut, HoldsAllWindowsAndFewLights) {
    const FarLights all = lights(0), few = lights(kSpread);
    EXPECT_LT(few.lights.size(), all.lights.size() * 2 / 3);
    EXPECT_EQ(few.roots.size(), all.roots.size());
    std::vector<std::uint8_t> on(windows_.size(), 1);
    for (std::size_t i = 0; i < on.size(); i += 3) {
        on[i] = 0;
    }
    const vec3 sum = emissionOf(all, scene_, on).front();
    const vec3 sumOfFew = emissionOf(few, scene_, on).front();
    EXPECT_NEAR(sumOfFew.x, sum.x, 1e-5f * sum.x);
    EXPECT_NEAR(sumOfFew.z, sum.z, 1e-5f * sum.z);
}

// From far away bricks are large, and each looks into the windows that it holds.
TEST_F(FarLightsCut, NeedsNoMoreLightsThanPlanned) {
    FarDetail detail;
    const vec3 away(240, -4000, 2000);
    detail.nodes.spacing = 1;
    detail.eyes = {&away, 1};
    detail.mostBricks = 6;
    layout_ = layoutFarField(media_, detail);
    const std::uint64_t planned = plannedFarLights(layout_, windows_.size());
    EXPECT_LT(planned, 2 * windows_.size());
    EXPECT_GT(lights(kSpread).lights.size(), 800 * layout_.bricks.size());
    EXPECT_LE(lights(kSpread).lights.size(), planned);
}

// A window in a bundle counts as one that stands for itself.
TEST_F(FarLightsCut, ABundleChangesWithItsWindows) {
    const FarLights few = lights(kSpread);
    ASSERT_FALSE(few.bundles.empty());
    const FarBundle& bundle = few.bundles.front();
    ASSERT_GT(bundle.windowCount, 1u);
    std::vector<std::uint8_t> on(windows_.size(), 1);
    const std::vector<vec3> before = emissionOf(few, scene_, on);
    on[few.bundled[bundle.firstWindow + 1]] = 0;
    const std::vector<vec3> after = emissionOf(few, scene_, on);
    const std::vector<uint> changed = changedLights(few, before, after);
    const auto hasChanged = [&](uint light) {
        return (changed[light / 32] >> (light % 32) & 1u) != 0;
    };
    EXPECT_TRUE(hasChanged(0));
    EXPECT_TRUE(hasChanged(bundle.light));
    EXPECT_FLOAT_EQ(before[bundle.light].x - after[bundle.light].x, 50);
    EXPECT_EQ(std::count(before.begin(), before.end(), vec3(0)), 0);
}

}  // namespace
}  // namespace nightcity
