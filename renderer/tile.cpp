// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "tile.h"

#include <charconv>
#include <optional>
#include <string_view>

#include "errors.h"

namespace nightcity {

namespace {

std::optional<std::uint32_t> wholeNumber(std::string_view text) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    return whole ? std::optional(value) : std::nullopt;
}

}  // namespace

Tile parseTile(const std::string& text) {
    const std::size_t slash = text.find('/');
    const auto number = wholeNumber(std::string_view(text).substr(0, slash));
    const auto count = slash == std::string::npos
                           ? std::nullopt
                           : wholeNumber(std::string_view(text).substr(slash + 1));
    if (!number || !count || *number == 0 || *number > *count) {
        throw UsageError("--tile " + text + ": give NUMBER/COUNT, like 2/4 for the second of four");
    }
    return {*number, *count};
}

std::string tileName(Tile tile) {
    return std::to_string(tile.number) + "/" + std::to_string(tile.count);
}

RowRange tileRows(Tile tile, std::uint32_t height) {
    if (tile.count > height) {
        throw UsageError("--tile " + tileName(tile) + ": a frame of " + std::to_string(height) +
                         " rows has at most as many tiles");
    }
    const auto rowBefore = [&](std::uint32_t tiles) {
        return static_cast<std::uint32_t>(std::uint64_t{height} * tiles / tile.count);
    };
    return {rowBefore(tile.number - 1), rowBefore(tile.number) - rowBefore(tile.number - 1)};
}

std::filesystem::path tileFile(const std::filesystem::path& file, Tile tile) {
    const std::string count = std::to_string(tile.count);
    std::string number = std::to_string(tile.number);
    number.insert(0, count.size() - number.size(), '0');
    std::filesystem::path name = file.stem();
    name += "." + number + "of" + count;
    name += file.extension();
    return file.parent_path() / name;
}

}  // namespace nightcity
