// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which frames to render, and what their files are called.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace nightcity {

// "1-10x2,20": frames 1, 3, 5, 7, 9 and 20, ascending, each once; 1-10:2 is the same, as
// OpenJobDescription has it. Throws UsageError.
std::vector<int> parseFrames(const std::string& text);

// Whether the file's name has a place for the frame: #### or %04d.
bool hasFramePlace(const std::filesystem::path& file);

// With the frame in its place, filled with zeros to its width; as it is without one.
std::filesystem::path frameFile(const std::filesystem::path& file, int frame);

}  // namespace nightcity
