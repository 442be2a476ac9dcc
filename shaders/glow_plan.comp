// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The first round of rays of a band: the first pixel of every cell, and where a cell sees
// several faces, every other pixel and all of its mixed quarters. One thread a cell.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "glow_cells.glsl"

layout(local_size_x = kGroupSize) in;

bool seesOneFace(ivec2 first, ivec2 last) {
    uint face = faceSeen(first);
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            if (faceSeen(ivec2(x, y)) != face) {
                return false;
            }
        }
    }
    return true;
}

void main() {
    GlowTable table = glowTable;
    uint index = gl_GlobalInvocationID.x;
    if (index >= table.columnCells * table.rowCells) {
        return;
    }
    ivec2 cell = ivec2(index % table.columnCells, index / table.columnCells);
    CellSpan span = cellSpan(cell, table);
    askForOwn(cell, 1u, table, 0u);
    if (!isKeptCell(cell, table)) {
        return;
    }
    if (table.everyPixel != 0u) {
        askForOwn(cell, kAllPixels, table, 0u);
        return;
    }
    askFor(span.last, table, 0u);
    askFor(ivec2(span.first.x, span.last.y), table, 0u);
    askFor(ivec2(span.last.x, span.first.y), table, 0u);
    if (seesOneFace(span.first, span.last)) {
        return;
    }
    askForMore(cell, table, 0u);
    for (int quarter = 0; quarter < 4; ++quarter) {
        ivec2 from = ivec2(quarter & 1, quarter >> 1) * 2;
        ivec2 first = span.first + from;
        if (!isClipped(span) && !seesOneFace(first, first + 2)) {
            askForOwn(cell, 0x33u << uint(from.y * int(kGlowCell) + from.x), table, 0u);
        }
    }
}
