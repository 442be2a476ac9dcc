// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The cells of kGlowCell x kGlowCell pixels of a band (shared/glow.h). A cell's corners are
// its first pixel and those of the cells after it; at the right and lower border of the frame
// its last pixels.
#ifndef NIGHTCITY_SHADERS_GLOW_CELLS_GLSL
#define NIGHTCITY_SHADERS_GLOW_CELLS_GLSL

#include "addresses.glsl"
#include "glow.h"
#include "primitives.glsl"

NIGHTCITY_ARRAY(GlowSampleArray, GlowSample)
NIGHTCITY_ARRAY(GlowRoundArray, GlowRound)

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer GlowReference {
    GlowTable table;
};

#define glowTable GlowReference(frameTable.glowTable).table

const uint kOwnPixels = 16u;       // shift of the high half of a cell
const uint kAllPixels = 0xffffu;
const uint kEvenPixels = 0x0505u;  // of every other row and column

// Of the whole band or one of its cells: columns and rows of pixels, inclusive.
struct CellSpan {
    ivec2 first;
    ivec2 last;   // the opposite corner
};

CellSpan cellSpan(ivec2 cell, GlowTable table) {
    ivec2 first = cell * int(kGlowCell);
    ivec2 most = ivec2(frameTable.width, table.rows) - 1;
    return CellSpan(first, min(first + int(kGlowCell), most));
}

uint pixelIndex(ivec2 at) {
    return uint(at.y) * frameTable.width + uint(at.x);
}

// Which plane a pixel sees: pixels of one number are on one plane, windows and the wall behind
// them too. kNone: none.
uint planeSeen(ivec2 at) {
    uint primitive = SurfaceRecordArray(frameTable.surfaces).at[pixelIndex(at)].primitive;
    if (primitive >= kGroundPrimitive) {
        return primitive;
    }
    return isPane(primitive)
               ? UintArray(sceneTable.windowPlane).at[primitive & ~kPanePrimitive]
               : UintArray(sceneTable.trianglePlane).at[primitive];
}

// The same for what has an edge in the glow: panes apart from the wall behind them, for along
// their edges glow rises steeply.
uint faceSeen(ivec2 at) {
    uint primitive = SurfaceRecordArray(frameTable.surfaces).at[pixelIndex(at)].primitive;
    return isPane(primitive) ? primitive : planeSeen(at);
}

uint bitOf(ivec2 at) {
    ivec2 within = at & int(kGlowCell - 1u);
    return 1u << uint(within.y * int(kGlowCell) + within.x);
}

// Asks for the glow along a pixel's ray in this round, unless it was asked for before.
void askFor(ivec2 at, GlowTable table, uint round) {
    uint bit = bitOf(at);
    uint cell = (uint(at.y) / kGlowCell) * table.columnCells + uint(at.x) / kGlowCell;
    if ((atomicOr(UintArray(table.cells).at[cell], bit) & bit) != 0u) {
        return;
    }
    uint slot = atomicAdd(GlowRoundArray(table.rounds).at[round].count, 1u);
    if (slot % kGroupSize == 0u) {
        atomicAdd(GlowRoundArray(table.rounds).at[round].groups, 1u);
    }
    UintArray(table.lists).at[round * table.capacity + slot] = pixelIndex(at);
}

// Asks for those pixels of a cell, as its own.
void askForOwn(ivec2 cell, uint pixels, GlowTable table, uint round) {
    CellSpan span = cellSpan(cell, table);
    ivec2 within = min(span.last - span.first, ivec2(kGlowCell - 1u));
    for (int y = 0; y <= within.y; ++y) {
        for (int x = 0; x <= within.x; ++x) {
            ivec2 at = span.first + ivec2(x, y);
            if ((pixels & bitOf(at)) != 0u) {
                askFor(at, table, round);
            }
        }
    }
    uint index = uint(cell.y) * table.columnCells + uint(cell.x);
    atomicOr(UintArray(table.cells).at[index], pixels << kOwnPixels);
}

bool isClipped(CellSpan span) {
    return any(lessThan(span.last - span.first, ivec2(kGlowCell)));
}

// Asks for the corners of the cell's quarters: every other pixel, those of its right and lower
// side too. Of a cell at the border of the frame, for all pixels.
void askForMore(ivec2 cell, GlowTable table, uint round) {
    CellSpan span = cellSpan(cell, table);
    askForOwn(cell, isClipped(span) ? kAllPixels : kEvenPixels, table, round);
    for (int k = 0; k <= int(kGlowCell); k += 2) {
        askFor(min(span.first + ivec2(kGlowCell, k), span.last), table, round);
        askFor(min(span.first + ivec2(k, kGlowCell), span.last), table, round);
    }
}

bool isKeptCell(ivec2 cell, GlowTable table) {
    return uint(cell.y) >= table.firstKeptCell &&
           uint(cell.y) < table.firstKeptCell + table.keptCells;
}

GlowSample sampleAt(ivec2 at, GlowTable table) {
    return GlowSampleArray(table.samples).at[pixelIndex(at)];
}

vec4 packSample(GlowSample found) {
    return vec4(found.glow, found.depth);
}

vec4 valueAt(ivec2 at, GlowTable table) {
    return packSample(sampleAt(at, table));
}

#endif
