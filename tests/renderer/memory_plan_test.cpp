// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What a frame is foretold to hold on the device, against what it held at most.
#include <gtest/gtest.h>

#include "device_frame.h"
#include "errors.h"

namespace nightcity {
namespace {

RenderSettings settingsOf(Method method) {
    RenderSettings settings;
    settings.method = method;
    settings.tolerance = 0.1;
    settings.samples = 1;
    if (method != Method::march) {
        settings.model = {Lights::all, Visibility::full, Emitter::pane};
    }
    if (method == Method::gauss) {  // without occlusion it is quick
        settings.model = {Lights::listed, Visibility::none, Emitter::isotropic};
    }
    return settings;
}

// A delegate of its own: the peak of a device is that of all that was done on it.
class MemoryPlanOf : public testing::TestWithParam<Method> {};

TEST_P(MemoryPlanOf, IsNotLessThanWhatIsHeldAndNotMuchMore) {
    const FlatScene scene = paperCity(2).load();
    const RenderProduct product = productOf("street", 320, 180);
    const RenderSettings settings = settingsOf(GetParam());
    const auto delegate = RenderDelegate::create({});
    const std::uint64_t planned = delegate->planMemory(scene, product, settings);
    delegate->sync(scene, product.camera, product.frame, settings, {});
    delegate->render(product, settings, {});
    const RenderStatistics statistics = delegate->statistics();
    EXPECT_EQ(statistics.plannedBytes, planned);
    EXPECT_GE(planned, statistics.devicePeakBytes);
    EXPECT_LE(double(planned), 1.5 * double(statistics.devicePeakBytes));
    EXPECT_GE(statistics.devicePeakBytes, statistics.deviceMemoryBytes);
    std::uint64_t sum = 0;
    for (const auto& [name, bytes] : statistics.deviceMemory) {
        sum += bytes;
    }
    EXPECT_EQ(sum, statistics.deviceMemoryBytes);
}

INSTANTIATE_TEST_SUITE_P(Methods, MemoryPlanOf,
                         testing::Values(Method::march, Method::gauss, Method::path,
                                         Method::field));

TEST(MemoryPlan, ABudgetIsRefusedWithTheFigureOrKept) {
    const FlatScene scene = paperCity(1).load();
    const RenderProduct product = productOf("street", 64, 36);
    const RenderSettings settings = settingsOf(Method::march);
    DeviceOptions options;
    options.memoryBytes = 1u << 20;
    const auto small = RenderDelegate::create(options);
    std::string refusal;
    try {
        small->planMemory(scene, product, settings);
    } catch (const DeviceError& error) {
        refusal = error.what();
    }
    EXPECT_NE(refusal.find("--memory 1M is too little"), std::string::npos) << refusal;
    const std::uint64_t needed = small->statistics().plannedBytes;
    EXPECT_NE(refusal.find("needs " + std::to_string((needed + (1u << 20) - 1) >> 20) + "M"),
              std::string::npos) << refusal;

    options.memoryBytes = testDelegate().planMemory(scene, product, settings);
    const auto enough = RenderDelegate::create(options);
    enough->planMemory(scene, product, settings);
    enough->sync(scene, product.camera, product.frame, settings, {});
    enough->render(product, settings, {});
    EXPECT_LE(enough->statistics().devicePeakBytes, *options.memoryBytes);
}

// Whatever the plan missed is refused when it is asked for.
TEST(MemoryPlan, NothingBeyondTheBudgetIsAllocated) {
    const FlatScene scene = paperCity(1).load();
    const RenderProduct product = productOf("street", 64, 36);
    const RenderSettings settings = settingsOf(Method::march);
    DeviceOptions options;
    options.memoryBytes = testDelegate().planMemory(scene, product, settings);
    const auto delegate = RenderDelegate::create(options);
    delegate->planMemory(scene, product, settings);
    delegate->sync(scene, product.camera, product.frame, settings, {});
    EXPECT_THROW(delegate->render(productOf("street", 1920, 1080), settings, {}), DeviceError);
}

}  // namespace
}  // namespace nightcity
