// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/light_scene.h"

#include <limits>

#include "reference/lit_lists.h"

namespace nightcity {

LightScene::LightScene(const FlatScene& scene, int frame, const RenderSettings& settings)
    : model(settings.model),
      reach(settings.reach.value_or(std::numeric_limits<double>::infinity())),
      mediaBoxes(scene.mediaBoxes),
      occluders(scene),
      haze(settings.media ? scene.mediaBoxes : std::span<const MediaBox>()),
      media(settings.media),
      windows(litWindows(scene, frame)),
      groups(windows, settings.model.emitter) {
    if (model.lights == Lights::all) {
        return;
    }
    std::vector<std::uint32_t> place(scene.windows.size(), kNone);
    for (std::uint32_t i = 0; i < windows.size(); ++i) {
        place[windows[i].window] = i;
    }
    for (const auto& list : litLists(scene, frame, settings.lightCap)) {
        std::vector<std::uint32_t>& box = listed.emplace_back();
        for (const std::uint32_t window : list) {
            if (place[window] != kNone) {  // without power: lit, but none that counts
                box.push_back(place[window]);
            }
        }
    }
}

}  // namespace nightcity
