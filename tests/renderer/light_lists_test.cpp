// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The packed light lists, their pages, and frames from them.
#include <bit>
#include <random>

#include <gtest/gtest.h>

#include "device_frame.h"
#include "passes/light_buffers.h"
#include "passes/light_lists.h"
#include "reference/reference_renderer.h"

namespace nightcity {
namespace {

// `boxes` boxes in a row, each with all of `windows` spheres around them.
SceneBuilder manyLights(std::uint32_t windows, std::uint32_t boxes) {
    SceneBuilder city;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    const vec3 colours[] = {{1, 0.8f, 0.5f}, {0.5f, 0.9f, 1}, {1, 1, 1}};
    std::vector<uint> all;
    for (std::uint32_t i = 0; i < windows; ++i) {
        const vec3 place(20 * unit(random) - 5, 6 + 5 * unit(random), 10 * unit(random));
        city.addWindow(place, {0.1f, 0, 0}, {0, 0, 0.1f}, 50, colours[i % 3], false);
        city.windows.back().flags |= kWindowSphere;
        all.push_back(i);
    }
    const auto edge = [boxes](std::uint32_t i) { return 10.0f * float(i) / float(boxes); };
    for (std::uint32_t i = 0; i < boxes; ++i) {
        city.addMediaBox({edge(i), 0, 0}, {edge(i + 1), 5, 10}, 0.02f, 0.9f, all);
    }
    city.addCamera("side", {-6, -20, 5}, {5, 2, 5}, 30);
    return city;
}

std::uint32_t runLength(glm::vec4 run) {
    return std::bit_cast<std::uint32_t>(run.w) & kRunLengthMask;
}

TEST(LightLists, AreRunsOfEqualEmissionWithoutDarkWindows) {
    SceneBuilder city = manyLights(7, 1);
    const FlatScene scene = city.load();
    std::vector<std::uint8_t> on(7, 1);
    on[3] = 0;
    const PackedLights lights = packLights(scene, on, {});
    ASSERT_EQ(lights.media.size(), 1u);
    EXPECT_EQ(lights.media[0].lightCount, 6u);
    EXPECT_EQ(lights.media[0].entryCount, 9u);  // 3 runs
    EXPECT_EQ(lights.capacity, 10u);
    const std::uint32_t expected[3][2] = {{0, 6}, {1, 4}, {2, 5}};  // window 3 is off
    for (int run = 0; run < 3; ++run) {
        const glm::vec4 head = lights.entries[3 * std::size_t(run)];
        EXPECT_EQ(runLength(head), 2u);
        EXPECT_EQ(glm::vec3(head), 50.0f * scene.windows[expected[run][0]].colour);
        for (int i = 0; i < 2; ++i) {
            EXPECT_EQ(glm::vec3(lights.entries[3 * std::size_t(run) + 1 + std::size_t(i)]),
                      scene.windows[expected[run][i]].centre - scene.mediaBoxes[0].lo);
        }
    }
}

TEST(LightLists, CapKeepsTheFirstLitWindows) {
    const FlatScene scene = manyLights(9, 2).load();
    std::vector<std::uint8_t> on(9, 1);
    on[0] = 0;
    const PackedLights lights = packLights(scene, on, 4);
    EXPECT_EQ(lights.media[1].lightCount, 4u);
    EXPECT_LE(lights.entries.size(), lights.capacity);
    // Windows 1, 2, 3, 4: emissions 1, 2, 0, 1.
    EXPECT_EQ(lights.media[1].entryCount, 7u);
}

TEST(LightLists, CapacityHoldsWhateverIsLit) {
    const FlatScene scene = manyLights(40, 3).load();
    std::mt19937 random(3);
    const std::uint64_t capacity = packLights(scene, std::vector<std::uint8_t>(40, 1), 12).capacity;
    for (int i = 0; i < 50; ++i) {
        std::vector<std::uint8_t> on(40);
        for (std::uint8_t& state : on) {
            state = random() % 2;
        }
        const PackedLights lights = packLights(scene, on, 12);
        EXPECT_EQ(lights.capacity, capacity);
        EXPECT_LE(lights.entries.size(), capacity);
    }
}

gpu::DeviceLimits limits(std::uint32_t range, std::uint32_t buffers) {
    gpu::DeviceLimits limits;
    limits.uniformBufferRange = range;
    limits.storageBufferRange = 1u << 27;
    limits.uniformBuffersPerStage = buffers;
    limits.uniformBuffersPerSet = buffers;
    limits.resourcesPerStage = 1000;
    return limits;
}

TEST(LightPages, AreAsManyAsTheListsNeed) {
    std::string note;
    const auto uniform = LightStorage::uniform;
    EXPECT_EQ(chooseLightPages(limits(65536, 12), "card", 0, uniform, note),
              (LightPages{uniform, 4096, 1}));
    EXPECT_EQ(chooseLightPages(limits(65536, 12), "card", 4096, uniform, note),
              (LightPages{uniform, 4096, 1}));
    EXPECT_EQ(chooseLightPages(limits(65536, 12), "card", 4097, uniform, note),
              (LightPages{uniform, 4096, 2}));
    EXPECT_EQ(chooseLightPages(limits(20000, 12), "card", 4097, uniform, note),
              (LightPages{uniform, 1024, 5}));
    EXPECT_EQ(note, "");
}

TEST(LightPages, FallBackToStorageWithAWordWhereTheDeviceBindsTooFew) {
    std::string note;
    const LightPages pages =
        chooseLightPages(limits(65536, 12), "card", 13 * 4096, LightStorage::uniform, note);
    EXPECT_EQ(pages, (LightPages{LightStorage::storage, 1u << 22, 1}));
    EXPECT_NE(note.find("13 uniform buffers"), std::string::npos) << note;
    EXPECT_NE(note.find("at most 12"), std::string::npos) << note;
    EXPECT_EQ(chooseLightPages(limits(65536, 12), "card", 5u << 20, LightStorage::storage, note),
              (LightPages{LightStorage::storage, 1u << 22, 2}));
    EXPECT_EQ(note, "");
}

class StoredLists : public testing::TestWithParam<LightStorage> {};

void expectAgreement(const FlatScene& scene, const RenderSettings& settings,
                     std::uint32_t uniformPages) {
    const RenderProduct product = productOf("side", 12, 9);
    RenderStatistics statistics;
    const Frame frame = renderOnDevice(scene, product, settings, &statistics);
    const ReferenceImage reference = renderReference(scene, product, settings, {});
    EXPECT_LT(glowErrors(frame, reference.frame).worst, 1e-5);
    EXPECT_EQ(statistics.lightEvaluations, reference.statistics.lightEvaluations);
    const bool uniform = settings.lightStorage == LightStorage::uniform;
    EXPECT_EQ(statistics.lightPages, uniform ? uniformPages : 1u);
    EXPECT_EQ(statistics.lightStorage, uniform ? "uniform" : "storage");
}

// More steps times lights than 65,535, where one software driver stopped counting.
TEST_P(StoredLists, AListLongerThanAPageIsReadToItsEnd) {
    const FlatScene scene = manyLights(9000, 1).load();
    for (const MarchOrder order : {MarchOrder::lights, MarchOrder::steps}) {
        RenderSettings settings;
        settings.lightStorage = GetParam();
        settings.marchOrder = order;
        expectAgreement(scene, settings, 3);
    }
}

TEST_P(StoredLists, MoreThanAHundredPagesAreRead) {
    const FlatScene scene = manyLights(5000, 90).load();
    RenderSettings settings;
    settings.lightStorage = GetParam();
    settings.subdivisions = 2;
    expectAgreement(scene, settings, 110);
}

TEST_P(StoredLists, CapBringsThePapersLimitBack) {
    const FlatScene scene = manyLights(100, 2).load();
    RenderSettings settings;
    settings.lightStorage = GetParam();
    settings.lightCap = 40;
    expectAgreement(scene, settings, 1);
}

INSTANTIATE_TEST_SUITE_P(Storage, StoredLists,
                         testing::Values(LightStorage::uniform, LightStorage::storage),
                         [](const auto& info) {
                             return info.param == LightStorage::uniform ? "Uniform" : "Storage";
                         });

}  // namespace
}  // namespace nightcity
