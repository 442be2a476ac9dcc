// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "sample_positions.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace nightcity {
namespace {

RenderSettings samples(std::uint32_t count, Filter filter, std::uint64_t seed = 0) {
    RenderSettings settings;
    settings.pixelSamples = count;
    settings.filter = filter;
    settings.seed = seed;
    return settings;
}

TEST(SamplePositions, OneSampleIsTheCentreWhateverTheFilter) {
    for (const Filter filter : {Filter::box, Filter::gauss}) {
        const auto positions = samplePositions(samples(1, filter, 7));
        ASSERT_EQ(positions.size(), 1u);
        EXPECT_EQ(positions[0], glm::vec2(0));
    }
}

TEST(SamplePositions, BoxFillsThePixelEvenly) {
    const auto positions = samplePositions(samples(256, Filter::box));
    std::set<std::pair<int, int>> cells;
    for (const glm::vec2 p : positions) {
        EXPECT_GE(std::min(p.x, p.y), -0.5f);
        EXPECT_LT(std::max(p.x, p.y), 0.5f);
        cells.emplace(int(std::floor((p.x + 0.5f) * 8)), int(std::floor((p.y + 0.5f) * 8)));
    }
    EXPECT_EQ(cells.size(), 64u) << "an empty cell of 8 x 8 with 256 samples is no low discrepancy";
}

TEST(SamplePositions, GaussHasTheVarianceOfTheTruncatedGaussian) {
    const auto positions = samplePositions(samples(4096, Filter::gauss));
    double sum = 0;
    for (const glm::vec2 p : positions) {
        EXPECT_LE(glm::length(p), 1.5f);
        sum += double(glm::dot(p, p));
    }
    // Mean of r^2 for sigma 0.5 cut at radius R = 1.5, with q = exp(-R^2 / 2 sigma^2):
    // 2 sigma^2 - R^2 q / (1 - q).
    const double q = std::exp(-4.5);
    EXPECT_NEAR(sum / 4096, 0.5 - 2.25 * q / (1 - q), 1e-3);
}

TEST(SamplePositions, SeedShiftsAndRepeats) {
    const auto a = samplePositions(samples(16, Filter::box, 1));
    EXPECT_EQ(a, samplePositions(samples(16, Filter::box, 1)));
    EXPECT_NE(a, samplePositions(samples(16, Filter::box, 2)));
}

TEST(SamplePositions, CentreSampleIsTheNearestAndTheFirstOfEquals) {
    const std::vector<glm::vec2> positions{{0.4f, 0}, {0, 0.1f}, {-0.1f, 0}};
    EXPECT_EQ(centreSample(positions), 1u);
}

}  // namespace
}  // namespace nightcity
