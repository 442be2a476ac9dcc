// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Higher orders of --method field against the path tracer, its slow twin, and the same however the
// windows came to be on.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "device_frame.h"
#include "reference/reference_renderer.h"
#include "render_delegate.h"

namespace nightcity {
namespace {

constexpr float kThick = 0.05f;  // 1/m: higher orders bring as much as the first

RenderSettings settingsOf(Method method, Surfaces surfaces) {
    RenderSettings settings;
    settings.method = method;
    settings.model = {Lights::all, Visibility::full, Emitter::pane, Scattering::multiple, surfaces};
    settings.tolerance = method == Method::field ? std::optional(0.1) : std::nullopt;
    settings.samples = 8192;
    return settings;
}

double sum(const Frame& frame) {
    double total = 0;
    for (const glm::vec3& value : frame.glow) {
        total += value.y;
    }
    return total;
}

class FieldOrders : public testing::TestWithParam<Surfaces> {
protected:
    FieldOrders() {
        product_.aovs = kAovGlow;  // lit surfaces themselves take long, and are no part of it
        product_.pixels = selectPixels(scene_, product_, 48, 5);
    }

    FlatScene scene_ = paperCity(1, kThick).load();
    RenderProduct product_ = productOf("overview75", 640, 360);
};

TEST_P(FieldOrders, AgreeWithPaths) {
    const Frame paths = renderOnDevice(scene_, product_, settingsOf(Method::path, GetParam()));
    RenderSettings fine = settingsOf(Method::field, GetParam());
    fine.tolerance = 0.03;
    const Frame field = renderOnDevice(scene_, product_, fine);
    RenderSettings first = settingsOf(Method::field, Surfaces::dim);
    first.model.scattering = Scattering::single;
    const double truth = sum(paths);
    EXPECT_LT(sum(renderOnDevice(scene_, product_, first)), 0.7 * truth);
    EXPECT_NEAR(sum(field) / truth, 1, 0.015);
    std::vector<double> errors;
    for (std::size_t i = 0; i < paths.glow.size(); ++i) {
        if (paths.glow[i].y > 0) {
            errors.push_back(std::abs(double(field.glow[i].y) / double(paths.glow[i].y) - 1));
        }
    }
    ASSERT_GT(errors.size(), 40u);
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[errors.size() / 2], 0.02);
    EXPECT_LT(errors[errors.size() * 9 / 10], 0.06);
}

TEST_P(FieldOrders, AToggledStateEqualsAFreshBakeToTheBit) {
    SceneBuilder city = paperCity(1, kThick);
    city.windowEvents = {{2, 1, 0}, {2, 40, 0}};
    const FlatScene scene = city.load();
    const RenderSettings settings = settingsOf(Method::field, GetParam());
    product_.frame = 2;
    const Frame fresh = renderOnDevice(scene, product_, settings);
    product_.frame = 1;
    const Frame before = renderOnDevice(scene, product_, settings);
    EXPECT_NE(before.glow, fresh.glow);
    product_.frame = 2;
    testDelegate().sync(scene, product_.camera, product_.frame, settings, {.geometry = false});
    testDelegate().render(product_, settings, {});
    EXPECT_EQ(testDelegate().resolve().glow, fresh.glow);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, FieldOrders, testing::Values(Surfaces::dim, Surfaces::lit),
                         [](const auto& surfaces) {
                             return surfaces.param == Surfaces::lit ? "lit" : "dim";
                         });

// Far away, the tree over the windows ends above single ones: of two states that differ only there,
// what is baked of the first order is the same, and what lit surfaces reflect is not.
TEST(FieldOrdersAlone, StatesThatDifferWithinOneLightOfTheTreeAreTwo) {
    SceneBuilder city;
    const uint wall = city.addMaterial(vec3(0.8f));
    city.ground = GroundPlane{0, wall};
    city.addBoxBuilding({-3, 3, 0}, {3, 6, 6}, wall);
    for (uint i = 0; i < 1024; ++i) {
        const vec3 centre(float(i % 32) * 0.2f, -150, 4 + float(i / 32) * 0.2f);
        for (const float behind : {0.0f, 0.4f}) {
            city.addWindow(centre - vec3(0, behind, 0), {-0.01f, 0, 0}, {0, 0, 0.01f}, 50, vec3(1),
                           false);
        }
    }
    city.addMediaBox({-3, -1, 0}, {3, 3, 4}, kThick, 0.9f);
    city.addCamera("front", {0, -12, 3}, {0, 0, 2}, 40);
    for (uint i = 0; i < city.windows.size(); ++i) {  // first those at even numbers, then the others
        city.windows[i].flags = i % 2 == 0 ? city.windows[i].flags | kWindowOn
                                           : city.windows[i].flags & ~kWindowOn;
        city.windowEvents.push_back({2, i, i % 2});
    }
    const FlatScene scene = city.load();
    RenderSettings settings = settingsOf(Method::field, Surfaces::lit);
    RenderProduct product = productOf("front", 64, 48);
    product.aovs = kAovGlow;
    product.frame = 2;
    const Frame fresh = renderOnDevice(scene, product, settings);
    product.frame = 1;
    const Frame before = renderOnDevice(scene, product, settings);
    ASSERT_GT(sum(fresh), 0);
    EXPECT_NE(before.glow, fresh.glow);
    settings.model.scattering = Scattering::single;
    const Frame single = renderOnDevice(scene, product, settings);
    product.frame = 2;
    EXPECT_EQ(single.glow, renderOnDevice(scene, product, settings).glow);
    settings.model.scattering = Scattering::multiple;
    product.frame = 1;
    renderOnDevice(scene, product, settings);
    product.frame = 2;
    testDelegate().sync(scene, product.camera, product.frame, settings, {.geometry = false});
    testDelegate().render(product, settings, {});
    EXPECT_EQ(testDelegate().resolve().glow, fresh.glow);
}

// Nothing to look at: no windows, no haze, a white wall of haze.
TEST(FieldOrdersAlone, AreBlackWithoutLightAndBoundedWithoutLoss) {
    SceneBuilder dark = paperCity(1, kThick);
    for (Window& window : dark.windows) {
        window.power = 0;
    }
    RenderProduct product = productOf("overview75", 64, 36);
    const RenderSettings settings = settingsOf(Method::field, Surfaces::dim);
    EXPECT_EQ(sum(renderOnDevice(dark.load(), product, settings)), 0);
    SceneBuilder clear = paperCity(1, kThick);
    clear.mediaBoxes.clear();
    EXPECT_EQ(sum(renderOnDevice(clear.load(), product, settings)), 0);
    const Frame white = renderOnDevice(paperCity(1, 1, 1).load(), product, settings);
    EXPECT_GT(sum(white), 0);
    EXPECT_TRUE(std::isfinite(sum(white)));
}

}  // namespace
}  // namespace nightcity
