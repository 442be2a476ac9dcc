// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/flat_scene.h"

#include <algorithm>

#include "errors.h"
#include "scene/mapped_file.h"

namespace nightcity {

const CameraFrame& CameraTrack::at(int frame) const {
    const std::int64_t index = std::int64_t{frame} - firstFrame;
    return frames[std::size_t(std::clamp<std::int64_t>(index, 0, std::int64_t(frames.size()) - 1))];
}

const CameraTrack& FlatScene::camera(const std::string& name) const {
    std::string names;
    for (const CameraTrack& track : cameras) {
        if (track.name == name) {
            return track;
        }
        names += (names.empty() ? "" : ", ") + track.name;
    }
    throw UsageError("no camera is called '" + name + "'; this scene has " +
                     (names.empty() ? "none: add a camera to the stage and export again" : names));
}

void FlatScene::dropPages() const {
    if (file) {
        file->dropPages();
    }
}

std::vector<std::uint8_t> FlatScene::windowsOn(int frame) const {
    std::vector<std::uint8_t> on(windows.size());
    for (std::size_t i = 0; i < windows.size(); ++i) {
        on[i] = std::uint8_t(windows[i].flags & kWindowOn);
    }
    for (const WindowEvent& event : windowEvents) {  // sorted by frame
        if (event.frame > float(frame)) {
            break;
        }
        on[event.window] = std::uint8_t(event.on);
    }
    return on;
}

}  // namespace nightcity
