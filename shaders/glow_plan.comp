// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The first round of rays of a band: the first pixel of every cell, and where a cell sees
// several faces, every other pixel and more of its mixed quarters. Lists these as kOtherCells. One
// thread a cell.
#version 460
#extension GL_GOOGLE_include_directive : require

#define NIGHTCITY_KEEP_TABLES
#include "glow_cells.glsl"

layout(local_size_x = kGroupSize) in;

const int kSide = int(kGlowCell) + 1;

// Bit kSide y + x: the pixel (x, y) from the first sees the same face as the one left of it;
// in the second word, as the one above it.
uvec2 sameFaces(ivec2 first) {
    uvec2 same = uvec2(0u);
    uint above[kSide];
    for (int y = 0; y < kSide; ++y) {
        uint left = kNone;
        for (int x = 0; x < kSide; ++x) {
            uint face = faceSeen(first + ivec2(x, y));
            uint bit = 1u << uint(kSide * y + x);
            same.x |= x > 0 && face == left ? bit : 0u;
            same.y |= y > 0 && face == above[x] ? bit : 0u;
            left = face;
            above[x] = face;
        }
    }
    return same;
}

// Whether the pixels from (x, y) to (x + side, y + side) see one face.
bool isOneFace(uvec2 same, int x, int y, int side) {
    uint row = ((1u << uint(side)) - 1u) << uint(x + 1);
    uint rows = 0u;
    for (int k = 0; k <= side; ++k) {
        rows |= row << uint(kSide * (y + k));
    }
    uint column = 0u;
    for (int k = 1; k <= side; ++k) {
        column |= 1u << uint(kSide * (y + k) + x);
    }
    return (same.x & rows) == rows && (same.y & column) == column;
}

// Of a quarter that sees several faces, as a mask of its cell from its first pixel: all pixels but
// those halfway between two of its corners that see the same face as these.
uint raysOfMixed(uvec2 same, ivec2 from) {
    uint along = 6u << uint(kSide * from.y + from.x);
    uint down = (1u << uint(kSide) | 1u << uint(2 * kSide)) << uint(kSide * from.y + from.x);
    uint rays = 0x21u;
    rays |= (same.x & along) == along ? 0u : 0x02u;
    rays |= (same.y & down) == down ? 0u : 0x10u;
    return rays;
}

void main() {
    keepTables();
    GlowTable table = glowTable;
    uint index = gl_GlobalInvocationID.x;
    if (index >= table.columnCells * table.rowCells) {
        return;
    }
    ivec2 cell = cellAt(index, table);
    CellSpan span = cellSpan(cell, table);
    askForOwn(cell, 1u, table);
    if (!isKeptCell(cell, table)) {
        return;
    }
    if (table.everyPixel != 0u || isClipped(span)) {
        askForOwn(cell, kAllPixels, table);
        addToList(kOtherCells, index, table);
        return;
    }
    uvec2 same = sameFaces(span.first);
    if (isOneFace(same, 0, 0, int(kGlowCell))) {
        return;
    }
    askForMore(cell, table);
    addToList(kOtherCells, index, table);
    for (int quarter = 0; quarter < 4; ++quarter) {
        ivec2 from = ivec2(quarter & 1, quarter >> 1) * 2;
        if (!isOneFace(same, from.x, from.y, 2)) {
            askForOwn(cell, raysOfMixed(same, from) << uint(from.y * int(kGlowCell) + from.x),
                      table);
        }
    }
}
