// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Images that are not asked for are not written, and change nothing in the others.
#include <gtest/gtest.h>

#include "aovs.h"
#include "device_frame.h"

namespace nightcity {
namespace {

Frame renderAovs(const FlatScene& scene, std::uint32_t aovs, bool media, std::uint32_t samples) {
    RenderProduct product = productOf("overview75", 96, 53);
    product.aovs = aovs;
    RenderSettings settings;
    settings.media = media;
    settings.subdivisions = 2;
    settings.pixelSamples = samples;
    return renderOnDevice(scene, product, settings);
}

TEST(Aovs, AskedForAloneAreTheSame) {
    const FlatScene scene = paperCity(2).load();
    for (const bool media : {true, false}) {
        for (const std::uint32_t samples : {1u, 3u}) {
            const Frame all = renderAovs(scene, kAllAovs, media, samples);
            const Frame beauty = renderAovs(scene, kAovBeauty, media, samples);
            EXPECT_EQ(beauty.beauty, all.beauty);
            EXPECT_NE(beauty.depth, all.depth);
            EXPECT_NE(beauty.surface, all.surface);
            const Frame others = renderAovs(scene, kAovDepth | kAovMediaId | kAovTransmittance |
                                                       kAovGlow, media, samples);
            EXPECT_EQ(others.depth, all.depth);
            EXPECT_EQ(others.mediaId, all.mediaId);
            EXPECT_EQ(others.transmittance, all.transmittance);
            EXPECT_EQ(others.glow, all.glow);
            EXPECT_NE(others.beauty, all.beauty);
        }
    }
}

// The baseline of benches: every image of the surface frame is written, and none is looked up.
TEST(Aovs, WriteOnlyWritesEveryImageAndTracesNothing) {
    const FlatScene scene = paperCity(1).load();
    RenderSettings settings;
    settings.media = false;
    settings.writeOnly = true;
    RenderStatistics statistics;
    const Frame frame = renderOnDevice(scene, productOf("overview75", 64, 48), settings, &statistics);
    ASSERT_EQ(statistics.passes.size(), 1u);
    for (std::size_t i = 0; i < frame.beauty.size(); ++i) {
        const float value = float(i);
        ASSERT_EQ(frame.beauty[i], glm::vec4(value, value, value, 0));
        ASSERT_EQ(frame.surface[i], glm::vec3(value));
        ASSERT_EQ(frame.normal[i], glm::vec3(value));
        ASSERT_EQ(frame.depth[i], value);
    }
}

}  // namespace
}  // namespace nightcity
