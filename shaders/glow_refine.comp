// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Chooses more rays where glow bends too much between those of the rounds before, and sorts the
// cells by how they are interpolated. One thread a cell: kRefineSort goes through all, the others
// through a list with a few groups.
#version 460
#extension GL_GOOGLE_include_directive : require

#define NIGHTCITY_KEEP_TABLES
#include "glow_interpolation.glsl"

layout(local_size_x = kGroupSize) in;
layout(constant_id = NIGHTCITY_CONSTANT_STEP) const uint kStep = kRefineEdges;

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

// The depths before the four corners of a cell.
vec4 cornerDepths(CellSpan span, GlowTable table) {
    return vec4(sampleAt(span.first, table).depth,
                sampleAt(ivec2(span.last.x, span.first.y), table).depth,
                sampleAt(ivec2(span.first.x, span.last.y), table).depth,
                sampleAt(span.last, table).depth);
}

bool isTooBent(ivec2 cell, GlowTable table) {
    GlowPatch points = glowPatch(cell, table);
    vec4 depths = vec4(points.at[5].w, points.at[6].w, points.at[9].w, points.at[10].w);
    if (!all(greaterThan(depths, vec4(0.0))) || !points.isWhole) {
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

uint ownOf(uint index, GlowTable table) {
    return UintArray(table.cells).at[index] >> kOwnPixels;
}

void sortCell(uint index, GlowTable table) {
    ivec2 cell = cellAt(index, table);
    if (isKeptCell(cell, table) && ownOf(index, table) == 1u) {
        bool isHazy = any(greaterThan(cornerDepths(cellSpan(cell, table), table), vec4(0.0)));
        addToList(isHazy ? kHazyCells : kClearCells, index, table);
    }
}

void refineCell(uint index, GlowTable table) {
    ivec2 cell = cellAt(index, table);
    if (kStep == kRefineEdges) {
        if (ownOf(index, table) != kAllPixels) {
            askForOwn(cell, steepQuarters(cell, table), table);
        }
    } else if (kStep == kRefinePatches) {
        bool isBent = isTooBent(cell, table);
        if (isBent) {
            askForMore(cell, table);
        }
        addToList(isBent ? kOtherCells : kSmoothCells, index, table);
    } else if (ownOf(index, table) == kEvenPixels && areQuartersTooBent(cell, table)) {
        askForOwn(cell, kAllPixels, table);
    }
}

void main() {
    keepTables();
    GlowTable table = glowTable;
    if (kStep == kRefineSort) {
        if (gl_GlobalInvocationID.x < table.columnCells * table.rowCells) {
            sortCell(gl_GlobalInvocationID.x, table);
        }
        return;
    }
    const uint kList = kStep == kRefinePatches ? kHazyCells : kOtherCells;
    uint count = cellCount(kList, table);
    for (uint k = firstOfList(); k < count; k += kListGroups * kGroupSize) {
        refineCell(cellOfList(kList, k, table), table);
    }
}
