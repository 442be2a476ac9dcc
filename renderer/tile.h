// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Tiles: a giant frame in parts that fit into memory, or on several machines. A tile is a
// band of whole rows, so its pixels are those of the whole frame, to the bit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "settings.h"

namespace nightcity {

struct Tile {
    std::uint32_t number = 1;  // from 1, the topmost
    std::uint32_t count = 1;
};

// "2/4": the second of four. Throws UsageError.
Tile parseTile(const std::string& text);

// As --tile has it.
std::string tileName(Tile tile);

// Every row of the frame is in exactly one tile. Throws UsageError where a tile would have none.
RowRange tileRows(Tile tile, std::uint32_t height);

// Where the tile of an image goes: frame.0001.exr -> frame.0001.2of4.exr, the number as wide
// as the count.
std::filesystem::path tileFile(const std::filesystem::path& file, Tile tile);

}  // namespace nightcity
