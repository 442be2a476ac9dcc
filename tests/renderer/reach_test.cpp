// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// --reach: the methods on the device against the judge.
#include <cmath>

#include <gtest/gtest.h>

#include "device_frame.h"
#include "reference/reference_renderer.h"

namespace nightcity {
namespace {

class Reach : public testing::Test {
protected:
    Reach() { product_.pixels = selectPixels(scene_, product_, 32, 5); }

    RenderSettings settings(Method method, std::optional<double> reach) const {
        RenderSettings settings;
        settings.method = method;
        settings.model = {Lights::all, Visibility::full, Emitter::pane};
        settings.tolerance = 0.001;
        settings.samples = 4096;
        settings.seed = 3;
        settings.reach = reach;
        return settings;
    }

    Frame judge(std::optional<double> reach) const {
        return renderReference(scene_, product_, settings(Method::reference, reach), {}).frame;
    }

    static double sum(const Frame& frame) {
        double total = 0;
        for (const glm::vec3& glow : frame.glow) {
            total += glow.y;
        }
        return total;
    }

    FlatScene scene_ = paperCity(1).load();
    RenderProduct product_ = productOf("overview75", 640, 360);
};

TEST_F(Reach, GaussAndPathsLeaveOutWhatTheJudgeDoes) {
    const double limited = sum(judge(12));
    ASSERT_GT(limited, 0);
    EXPECT_LT(limited, 0.97 * sum(judge(std::nullopt)));
    EXPECT_NEAR(sum(renderOnDevice(scene_, product_, settings(Method::gauss, 12))) / limited, 1, 1e-3);
    const Frame paths = renderOnDevice(scene_, product_, settings(Method::path, 12));
    double variance = 0;
    for (const glm::vec3& error : paths.glowError) {
        variance += double(error.y) * error.y;
    }
    EXPECT_LT(std::sqrt(variance) / limited, 0.005);
    EXPECT_LT(std::abs(sum(paths) - limited), 3 * std::sqrt(variance));
}

TEST_F(Reach, BeyondTheCityChangesNothing) {
    for (const Method method : {Method::gauss, Method::path}) {
        RenderSettings few = settings(method, std::nullopt);
        few.samples = 32;
        const Frame unlimited = renderOnDevice(scene_, product_, few);
        few.reach = 1000;
        EXPECT_EQ(renderOnDevice(scene_, product_, few).glow, unlimited.glow);
    }
}

}  // namespace
}  // namespace nightcity
