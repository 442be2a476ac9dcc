// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The flat scene in memory (docs/scene_format.md): views into the mapped file,
// checked once by loadScene and trusted afterwards. No Vulkan.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene.h"

namespace nightcity {

class MappedFile;

// A camera over frames; one frame where it does not move.
struct CameraTrack {
    std::string name;
    std::string prim;
    int firstFrame = 1;
    std::span<const CameraFrame> frames;

    const CameraFrame& at(int frame) const;  // clamped to the frames that exist
};

struct GroundPlane {
    float height = 0;  // m
    uint material = 0;
};

// What the stage's UsdRender settings ask for where the command line is silent.
struct RenderDefaults {
    std::string camera;  // empty: none named
    uint width = 0;      // pixels; 0: not given
    uint height = 0;
    std::vector<std::string> aovs;
};

struct FrameRange {
    int first = 1;
    int last = 1;
    double perSecond = 24;
};

struct FlatScene {
    std::span<const vec3> positions;      // m
    std::span<const vec2> texcoords;      // empty or one a position
    std::span<const Triangle> triangles;  // opaque
    std::span<const Building> buildings;
    std::span<const Material> materials;
    std::span<const std::uint32_t> texels;  // R, G, B, A bytes, sRGB
    std::span<const Window> windows;
    std::span<const MediaBox> mediaBoxes;
    std::span<const std::uint32_t> lightList;  // into windows
    std::span<const WindowEvent> windowEvents;
    std::vector<CameraTrack> cameras;
    std::optional<GroundPlane> ground;
    FrameRange frames;
    RenderDefaults defaults;
    std::array<double, 3> origin{};  // m, of the stage
    std::string hash;                // 32 hexadecimal digits
    std::string generator;
    std::vector<std::string> notes;
    std::shared_ptr<const MappedFile> file;  // holds the spans; none: whoever made them does

    const CameraTrack& camera(const std::string& name) const;  // throws UsageError with the names
    // Lit windows at a frame, one byte each (docs/scene_format.md, window_event).
    std::vector<std::uint8_t> windowsOn(int frame) const;
    // Memory of the file that was read goes back to the system; what is read again comes again.
    // To be called after each pass over large arrays, so that these count once: on the device.
    void dropPages() const;
};

}  // namespace nightcity
