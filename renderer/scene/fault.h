// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// How a faulty flat scene is reported: file, field with its index, value, mend.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene.h"

namespace nightcity {

// Throws SceneError "FILE: FIELD is VALUE: MEND".
[[noreturn]] void failScene(const std::filesystem::path& file, const std::string& field,
                            const std::string& value, const std::string& mend);

// "window[12].power"; `component` 0 to 2 adds ".x", ".y" or ".z".
std::string fieldName(std::string_view array, std::size_t index, std::string_view field,
                      int component = -1);

std::string text(double value);  // 9 significant digits, "nan", "inf"
std::string text(vec3 value);    // "(1, 2, 3)"

}  // namespace nightcity
