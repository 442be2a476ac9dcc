// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Says where the far field is too coarse for what a camera sees: a large city from afar has more
// haze than its bricks resolve, and its glow is then off by tens of per cent.
#pragma once

#include <optional>
#include <string>

#include "passes/frame_renderer.h"
#include "scene/flat_scene.h"

namespace nightcity {

// A sentence for the user where the estimate is far above what the tolerance lets it be; else none.
std::optional<std::string> fieldAlarm(double estimate, double tolerance, std::uint64_t bricks);

// The alarm of what is rendered now. It takes a small frame with the field's own estimate of its
// error, once a camera, tolerance, model and number of bricks: a track of a camera is looked along
// from its first frame with a lit window.
class FieldAlarm {
public:
    void sceneChanged();
    // `flat` is what `scene` was synced with, its field included where the settings are of it.
    void update(gpu::Device& device, gpu::Commands& commands, const GpuScene& scene,
                const FlatScene& flat, const RenderProduct& product,
                const RenderSettings& settings);
    const std::optional<std::string>& note() const { return note_; }

private:
    struct View {
        std::string camera;
        double tolerance;
        Model model;
        std::optional<std::uint32_t> bricks;

        bool operator==(const View&) const = default;
    };

    std::optional<View> estimated_;  // what the note is of
    std::optional<std::string> note_;
};

}  // namespace nightcity
