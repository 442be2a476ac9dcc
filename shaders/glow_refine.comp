// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Chooses more rays where glow bends too much between those of the rounds before. push.round is 1
// for the corners of a cell's quarters, and for all pixels of quarters in a cell that sees several
// faces; 2 for all its pixels. One thread a cell.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "glow_interpolation.glsl"

layout(local_size_x = kGroupSize) in;

// In tolerances, what the cubic and the straight line may differ by halfway between two corners,
// of cells whose neighbourhood sees one face and of others: along the edge of a pane glow has a
// kink. And what parabolas may over a quarter, and glow itself between the corners of a
// quarter that is not curved. Measured on overviews of paper-4x4, so that interpolation
// keeps half the tolerance on 99 of 100 pixels.
const float kMostBend = 1.0;
const float kMostBendByEdge = 0.25;
const float kMostQuarterBend = 1.5;
const float kMostRise = 2.0;

// Whether the corners of a patch see one face.
bool seesOneFace(ivec2 cell) {
    ivec2 first = (cell - 1) * int(kGlowCell);
    uint face = faceSeen(first);
    bool isOne = true;
    for (int k = 1; k < 16; ++k) {
        isOne = faceSeen(first + int(kGlowCell) * ivec2(k & 3, k >> 2)) == face && isOne;
    }
    return isOne;
}

bool isTooBent(ivec2 cell, GlowTable table) {
    GlowPatch points = glowPatch(cell, table);
    bvec4 hazy = greaterThan(vec4(points.at[5].w, points.at[6].w, points.at[9].w, points.at[10].w),
                             vec4(0.0));
    if (!any(hazy)) {
        return false;
    }
    if (!all(hazy) || !points.isWhole) {
        return true;
    }
    float most = seesOneFace(cell) ? kMostBend : kMostBendByEdge;
    return bendOfPatch(points) > most * table.tolerance;
}

bool areQuartersTooBent(ivec2 cell, GlowTable table) {
    GlowQuarters points = glowQuarters(cell, table);
    for (int k = 0; k < 9; ++k) {
        if ((points.at[k].w > 0.0) != (points.at[0].w > 0.0)) {
            return true;
        }
    }
    return bendOfQuarters(points) > kMostQuarterBend * table.tolerance;
}

// The pixels of the quarters of a mixed cell between whose corners glow rises too much.
uint steepQuarters(ivec2 cell, GlowTable table) {
    GlowQuarters points = glowQuarters(cell, table);
    uint pixels = 0u;
    for (int quarter = 0; quarter < 4; ++quarter) {
        ivec2 from = ivec2(quarter & 1, quarter >> 1);
        int at = 3 * from.y + from.x;
        vec4 low = min(min(points.at[at], points.at[at + 1]),
                       min(points.at[at + 3], points.at[at + 4]));
        float rise = riseOfQuarter(points, at);
        if (rise > kMostRise * table.tolerance * largest(low)) {
            pixels |= 0x33u << uint(2 * (int(kGlowCell) * from.y + from.x));
        }
    }
    return pixels;
}

void main() {
    GlowTable table = glowTable;
    uint index = gl_GlobalInvocationID.x;
    if (index >= table.columnCells * table.rowCells) {
        return;
    }
    ivec2 cell = ivec2(index % table.columnCells, index / table.columnCells);
    uint own = UintArray(table.cells).at[index] >> kOwnPixels;
    if (!isKeptCell(cell, table)) {
        return;
    }
    if (push.round == 1u) {
        if (own == 1u) {
            if (isTooBent(cell, table)) {
                askForMore(cell, table);
            }
        } else if (own != kAllPixels) {
            askForOwn(cell, steepQuarters(cell, table), table);
        }
    } else if (own == kEvenPixels && areQuartersTooBent(cell, table)) {
        askForOwn(cell, kAllPixels, table);
    }
}
