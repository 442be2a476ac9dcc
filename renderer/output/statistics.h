// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// `--stats`: what was rendered, how fast, with how much memory (design section 7).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "frame.h"

namespace nightcity {

struct StatisticsReport {
    std::vector<std::pair<std::string, std::string>> settings;
    std::uint64_t buildings = 0;
    std::uint64_t windows = 0;
    std::uint64_t mediaBoxes = 0;
    std::uint64_t triangles = 0;  // of buildings, and as the paper counts: 12 a media box, 2 a window
    std::uint64_t lightListEntries = 0;
    double loadMilliseconds = 0;
    double bakeMilliseconds = 0;
    std::vector<double> updateMilliseconds;  // what later frames of a shot changed of the bake
    std::vector<RenderStatistics> frames;  // one a render call, in order; at least one
    std::vector<double> processorMilliseconds;  // of the process, one a render call
    std::vector<std::string> notes;
};

// Throws std::runtime_error naming the file.
void writeStatistics(const std::filesystem::path& file, const StatisticsReport& report);

}  // namespace nightcity
