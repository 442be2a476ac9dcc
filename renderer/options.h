// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The command line (design section 7), checked before any work.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "render_delegate.h"
#include "settings.h"
#include "tile.h"

namespace nightcity {

enum class ProgressStyle { automatic, terminal, lines, farm, none };

struct Options {
    std::filesystem::path scene;
    std::filesystem::path output;
    std::optional<std::string> camera;      // none: the stage's, else the first
    std::optional<glm::uvec2> size;         // pixels; none: the stage's, else 1920 x 1061
    std::optional<std::vector<int>> frames; // none: the stage's first
    RenderSettings settings;
    std::optional<std::uint32_t> pixelCount;            // --pixels N
    std::optional<std::filesystem::path> pixelFile;     // --pixels FILE
    std::optional<Tile> tile;               // none: the whole frame
    std::uint32_t repeat = 1;
    float exposure = 2;                     // EV: windows are white, glow shows, the ground stays dark
    std::optional<std::vector<std::string>> aovs;  // none: the stage's, else all
    DeviceOptions device;
    bool listDevices = false;
    std::filesystem::path stats;            // empty: none
    bool skipExisting = false;
    bool listMissing = false;               // instead of rendering
    ProgressStyle progress = ProgressStyle::automatic;
    std::string choice;                     // for the metadata; empty: none
};

// Nothing where --help or --version was asked for and answered on `out`. Throws
// UsageError.
std::optional<Options> parseOptions(int argc, const char* const* argv, std::ostream& out);

// Lines "x,y", a first line without digits aside, all inside the size; in the order of
// the file. Throws UsageError naming file and line.
std::vector<glm::uvec2> readPixels(const std::filesystem::path& file, glm::uvec2 size);

}  // namespace nightcity
