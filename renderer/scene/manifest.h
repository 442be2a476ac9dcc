// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// scene.json, parsed and checked against itself and the compiled records.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/flat_scene.h"
#include "scene/record_layout.h"

namespace nightcity {

struct ArrayRange {
    std::uint64_t offset = 0;  // bytes into scene.bin, a multiple of 64
    std::uint64_t count = 0;   // records
};

struct CameraEntry {
    std::string name;
    std::string prim;
    int firstFrame = 1;
    std::uint64_t first = 0;  // into camera_frame
    std::uint64_t count = 0;
};

struct Manifest {
    std::string generator;
    std::array<double, 3> origin{};  // m
    std::uint64_t binaryBytes = 0;
    std::string binaryHash;          // 32 hexadecimal digits
    std::array<ArrayRange, kSceneArrayCount> arrays;
    std::vector<CameraEntry> cameras;
    std::optional<GroundPlane> ground;
    FrameRange frames;
    RenderDefaults defaults;
    std::vector<std::string> notes;

    const ArrayRange& array(SceneArray name) const { return arrays[std::size_t(name)]; }
};

// Throws SceneError. Afterwards every array lies inside the binary, aligned and
// apart from the others, and every camera's records lie inside camera_frame.
Manifest parseManifest(std::span<const std::byte> bytes, const std::filesystem::path& file);

}  // namespace nightcity
