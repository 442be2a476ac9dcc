// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Frames as files: OpenEXR, PNG, JPEG, CSV.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "frame.h"

namespace nightcity {

enum class ImageFormat { exr, png, jpeg, csv };

// By the extension: .exr, .png, .jpg, .jpeg, .csv. Throws UsageError naming these.
ImageFormat imageFormat(const std::filesystem::path& file);

// What an image says of its making. No time, host or path: same input, same bytes.
struct ImageMetadata {
    // "nightcity:NAME" in EXR; lines "nightcity:NAME=VALUE" of the description in PNG
    // and JPEG.
    std::vector<std::pair<std::string, std::string>> entries;
    // Row vectors times these. Camera: x right, y up, looking along -z, metres. NDC:
    // (0, 0) top left to (1, 1) bottom right, z from 1 m (0) to infinity (1).
    std::array<float, 16> worldToCamera{};
    std::array<float, 16> worldToNdc{};
    double framesPerSecond = 24;
};

// Which rows of an image a file holds; only EXR can say so.
struct ImageRows {
    std::uint32_t first = 0;
    std::uint32_t imageHeight = 0;  // 0: the file is the whole image
};

struct ImageOptions {
    std::vector<std::string> aovs;  // EXR and CSV; empty: all
    float exposure = 0;             // PNG and JPEG: radiance times 2^exposure
    std::vector<glm::uvec2> pixels; // CSV: where the frame's entries lie
    ImageRows rows;                 // EXR
    std::string choice;             // how the settings were chosen; empty: by hand
};

// Writes the frame whole or not at all. Throws std::runtime_error naming the file,
// also where the frame holds NaN or infinity.
void writeImage(const std::filesystem::path& file, const Frame& frame,
                const ImageMetadata& metadata, const ImageOptions& options);

// Whether the file is an image of this size and these rows, readable to its last pixel,
// whose entry `name` is `value`. False for CSV.
bool isWholeImage(const std::filesystem::path& file, const std::string& name,
                  const std::string& value, std::uint32_t width, std::uint32_t height,
                  const ImageRows& rows = {});

}  // namespace nightcity
