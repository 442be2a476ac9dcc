// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace nightcity {

// Writes a file that appears under its name only when it is whole: under a hidden
// name in the same folder first (".NAME.PID.part", locked), then renamed; removed where it
// fails. What killed writers of the same file left behind, nobody holding its lock, is removed
// as well. Throws std::runtime_error naming the file and the cause.
void writeWholeFile(const std::filesystem::path& file, std::string_view bytes);

}  // namespace nightcity
