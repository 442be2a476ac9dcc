// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The arrays of scene.bin as this program was compiled to read them.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace nightcity {

// Order of recordLayouts().
enum class SceneArray : std::size_t {
    position, texcoord, triangle, building, material, texel,
    window, mediaBox, lightList, windowEvent, cameraFrame,
};
inline constexpr std::size_t kSceneArrayCount = 11;

struct FieldLayout {
    std::string_view name;
    std::string_view type;  // f32, u32, i32, u8
    std::size_t components;
    std::size_t offset;     // bytes
};

struct RecordLayout {
    std::string_view name;
    std::size_t stride;     // bytes
    std::span<const FieldLayout> fields;
};

std::span<const RecordLayout, kSceneArrayCount> recordLayouts();

}  // namespace nightcity
