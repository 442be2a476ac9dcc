// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "tile.h"

#include <gtest/gtest.h>

#include "errors.h"

namespace nightcity {
namespace {

TEST(Tile, EveryRowIsInExactlyOne) {
    for (const std::uint32_t height : {1u, 7u, 36u, 1061u, 65536u}) {
        for (const std::uint32_t count : {1u, 2u, 3u, 7u, 64u}) {
            if (count > height) {
                EXPECT_THROW(tileRows({1, count}, height), UsageError);
                continue;
            }
            std::uint32_t next = 0;
            for (std::uint32_t number = 1; number <= count; ++number) {
                const RowRange rows = tileRows({number, count}, height);
                EXPECT_EQ(rows.first, next);
                EXPECT_GE(rows.count, height / count);
                EXPECT_LE(rows.count, height / count + 1);
                next = rows.first + rows.count;
            }
            EXPECT_EQ(next, height);
        }
    }
}

TEST(Tile, NamesSortAsTheTilesDo) {
    EXPECT_EQ(tileFile("out/frame.0001.exr", parseTile("2/4")), "out/frame.0001.2of4.exr");
    EXPECT_EQ(tileFile("frame.exr", parseTile("7/128")), "frame.007of128.exr");
}

TEST(Tile, BadTextIsRefused) {
    for (const char* text : {"", "2", "0/4", "5/4", "2/", "/4", "a/b", "-1/4", "1/4x", "1/99999999999"}) {
        EXPECT_THROW(parseTile(text), UsageError) << text;
    }
}

}  // namespace
}  // namespace nightcity
