// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether a user hears of it where the field is too coarse for what the camera sees.
#include <algorithm>

#include <gtest/gtest.h>

#include "device_frame.h"
#include "passes/field_alarm.h"

namespace nightcity {
namespace {

bool saysTooCoarse(const std::vector<std::string>& notes) {
    return std::ranges::any_of(notes, [](const std::string& note) {
        return note.find("too coarse") != std::string::npos;
    });
}

RenderSettings fieldSettings() {
    RenderSettings settings;
    settings.method = Method::field;
    settings.model = {Lights::all, Visibility::none, Emitter::pane};
    settings.tolerance = 0.03;
    return settings;
}

TEST(FieldAlarms, AreOfEstimatesFarAboveTheTolerance) {
    EXPECT_FALSE(fieldAlarm(0.05, 0.03, 100));
    const std::optional<std::string> alarm = fieldAlarm(0.42, 0.03, 1750);
    ASSERT_TRUE(alarm);
    for (const char* part : {"1750 bricks", "42 %", "3 %", "--method gauss"}) {
        EXPECT_NE(alarm->find(part), std::string::npos) << part;
    }
}

bool isHeardWith(const RenderProduct& product, const RenderSettings& settings) {
    testDelegate().render(product, settings, {});
    return saysTooCoarse(testDelegate().notes());
}

// Three cubic kilometres of haze behind the camera take all bricks but large ones: of the one around
// the building, 2 km away, no node lies in the haze, which is not black for that. In a session that
// goes on with the scene, what was said of one tolerance, method or camera is not said of another.
TEST(FieldAlarms, AreHeardWhereBricksAreLarge) {
    SceneBuilder city = paperCity(1);
    city.addCamera("away", {-2000, 0, 200}, {0, 0, 15}, 2);
    city.addCamera("beside", {-13, -13, 10}, {0, 0, 12}, 60);
    const RenderProduct away = productOf("away", 48, 27), beside = productOf("beside", 48, 27);
    const RenderSettings settings = fieldSettings();
    const FlatScene small = city.load();
    renderOnDevice(small, away, settings);
    EXPECT_FALSE(saysTooCoarse(testDelegate().notes()));
    city.addMediaBox({-6050, -2000, 0}, {-2050, 2000, 200}, 1e-5f, 0.9f);
    const FlatScene large = city.load();
    const Frame frame = renderOnDevice(large, away, settings);
    std::size_t hazy = 0, black = 0;
    for (std::size_t i = 0; i < frame.glow.size(); ++i) {
        const bool isHazy = frame.transmittance[i] < 0.999f;
        hazy += isHazy ? 1 : 0;
        black += isHazy && frame.glow[i] == glm::vec3(0) ? 1 : 0;
    }
    EXPECT_GT(hazy, 100u);
    EXPECT_EQ(black, 0u);
    EXPECT_TRUE(saysTooCoarse(testDelegate().notes()));

    RenderSettings gauss = settings, coarse = settings;
    gauss.method = Method::gauss;
    coarse.tolerance = 0.9;
    EXPECT_FALSE(isHeardWith(away, gauss));
    EXPECT_FALSE(isHeardWith(away, coarse));
    EXPECT_TRUE(isHeardWith(away, settings));
    testDelegate().sync(large, "beside", beside.frame, settings, {.geometry = false});
    EXPECT_FALSE(isHeardWith(beside, settings));
}

}  // namespace
}  // namespace nightcity
