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
NIGHTCITY_ARRAY(GlowLedgerArray, GlowLedger)

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
    // One load, whichever array holds it.
    uvec2 planes = isPane(primitive) ? sceneTable.windowPlane : sceneTable.trianglePlane;
    return UintArray(planes).at[primitive & ~kPanePrimitive];
}

// The same for what has an edge in the glow: panes apart from the wall behind them, for along
// their edges glow rises steeply.
uint faceSeen(ivec2 at) {
    uint primitive = SurfaceRecordArray(frameTable.surfaces).at[pixelIndex(at)].primitive;
    bool isTriangle = primitive < kPanePrimitive;
    return isTriangle ? UintArray(sceneTable.trianglePlane).at[primitive] : primitive;
}

uint bitOf(ivec2 at) {
    ivec2 within = at & int(kGlowCell - 1u);
    return 1u << uint(within.y * int(kGlowCell) + within.x);
}

// Asks for the glow along a pixel's ray.
void askFor(ivec2 at, GlowTable table) {
    uint cell = (uint(at.y) / kGlowCell) * table.columnCells + uint(at.x) / kGlowCell;
    atomicOr(UintArray(table.cells).at[cell], bitOf(at));
}

// Which pixels of a cell are in the frame.
uint pixelsWithin(CellSpan span) {
    ivec2 within = min(span.last - span.first, ivec2(kGlowCell - 1u));
    uint columns = (2u << uint(within.x)) - 1u;
    uint rows = (2u << uint(4 * within.y + 3)) - 1u;
    return columns * 0x1111u & rows;
}

// Asks for those pixels of a cell, as its own.
void askForOwn(ivec2 cell, uint pixels, GlowTable table) {
    uint index = uint(cell.y) * table.columnCells + uint(cell.x);
    atomicOr(UintArray(table.cells).at[index],
             pixels << kOwnPixels | (pixels & pixelsWithin(cellSpan(cell, table))));
}

bool isClipped(CellSpan span) {
    return any(lessThan(span.last - span.first, ivec2(kGlowCell)));
}

// Asks for the corners of a whole cell's quarters: every other pixel, those of its right and
// lower side too.
void askForMore(ivec2 cell, GlowTable table) {
    CellSpan span = cellSpan(cell, table);
    askForOwn(cell, kEvenPixels, table);
    for (int k = 0; k <= int(kGlowCell); k += 2) {
        askFor(min(span.first + ivec2(kGlowCell, k), span.last), table);
        askFor(min(span.first + ivec2(k, kGlowCell), span.last), table);
    }
}

// Where a thread of kListGroups groups begins in a list; it goes on by as many as there are. Even
// groups first, as tileOfGroup has it.
uint firstOfList() {
    uint half_ = kListGroups / 2u;
    uint group = gl_WorkGroupID.x;
    uint slot = group < half_ ? 2u * group : 2u * (group - half_) + 1u;
    return slot * kGroupSize + gl_LocalInvocationIndex;
}

uint cellCount(uint list, GlowTable table) {
    return table.rows == 0u ? 0u : UintArray(table.lists).at[list];
}

// Index of cell `k` of a list.
uint cellOfList(uint list, uint k, GlowTable table) {
    return UintArray(table.lists).at[kCellLists + list * table.columnCells * table.rowCells + k];
}

void addToList(uint list, uint cell, GlowTable table) {
    uint k = atomicAdd(UintArray(table.lists).at[list], 1u);
    UintArray(table.lists).at[kCellLists + list * table.columnCells * table.rowCells + k] = cell;
}

ivec2 cellAt(uint index, GlowTable table) {
    return ivec2(index % table.columnCells, index / table.columnCells);
}

bool isKeptCell(ivec2 cell, GlowTable table) {
    return uint(cell.y) >= table.firstKeptCell &&
           uint(cell.y) < table.firstKeptCell + table.keptCells;
}

GlowSample sampleAt(ivec2 at, GlowTable table) {
    return GlowSampleArray(table.samples).at[pixelIndex(at)];
}

GlowLedger ledgerAt(ivec2 at, GlowTable table) {
    return GlowLedgerArray(table.ledger).at[pixelIndex(at)];
}

vec4 packSample(GlowSample found) {
    return vec4(found.glow, found.depth);
}

vec4 valueAt(ivec2 at, GlowTable table) {
    return packSample(sampleAt(at, table));
}

#endif
