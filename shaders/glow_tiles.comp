// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What the rays of a tile have in common: their list for this round, and in the first the lit
// panes whose near parts they may meet. One thread a tile.
#version 460
#extension GL_GOOGLE_include_directive : require

#define NIGHTCITY_KEEP_TABLES
#include "glow_tile.glsl"

layout(local_size_x = kTileGroup) in;

float depthAt(ivec2 at) {
    return SurfaceRecordArray(frameTable.surfaces).at[pixelIndex(at)].depth;
}

// Depth of the farthest surface on the rays of a cell, those of later rounds too: they end on
// planes that its corners see, and where it sees several, on surfaces of pixels looked at here.
float farthestOfCell(CellSpan span, uint own) {
    float farthest = 0.0;
    if (own == 1u) {
        farthest = max(max(depthAt(span.first), depthAt(span.last)),
                       max(depthAt(ivec2(span.first.x, span.last.y)),
                           depthAt(ivec2(span.last.x, span.first.y))));
    } else {
        for (int y = span.first.y; y <= span.last.y; ++y) {
            for (int x = span.first.x; x <= span.last.x; ++x) {
                farthest = max(farthest, depthAt(ivec2(x, y)));
            }
        }
    }
    return farthest;
}

// Cell n of a tile along Morton's curve: rays next to each other in the list are so on the screen
// too, and meet the same panes.
ivec2 alongCurve(uint n) {
    uvec2 bits = uvec2(n, n >> 1) & 0x15u;
    bits = (bits | bits >> 1) & 0x33u;
    return ivec2((bits | bits >> 2) & 0x7u);
}

// Without room for all of them, none: the host then makes room and starts anew.
void listPanes(RayBundle bundle, GlowTable table, inout GlowTile found) {
    found.paneCount = 0u;
    for (uint walk = 0u; nextNearPane(bundle, walk) != kNone;) {
        ++found.paneCount;
    }
    found.firstPane = atomicAdd(UintArray(table.paneCounter).at[0], found.paneCount);
    if (found.firstPane + found.paneCount > table.paneCapacity) {
        found.paneCount = 0u;
    }
    uint walk = 0u;
    for (uint k = 0u; k < found.paneCount; ++k) {
        UintArray(table.tilePanes).at[found.firstPane + k] = nextNearPane(bundle, walk);
    }
}

void main() {
    keepTables();
    keepNearTable();
    GlowTable table = glowTable;
    uint index = gl_GlobalInvocationID.x;
    if (index >= table.columnTiles * table.rowTiles) {
        return;
    }
    CellSpan cells = cellsOfTile(index, table);
    GlowTile found = GlowTileArray(table.tiles).at[index];
    found.rayCount = 0u;
    float farthest = 0.0;
    for (uint n = 0u; n < kTileCells * kTileCells; ++n) {
        ivec2 at = cells.first + alongCurve(n);
        if (any(greaterThan(at, cells.last))) {
            continue;
        }
        uint cell = uint(at.y) * table.columnCells + uint(at.x);
        uint word = UintArray(table.cells).at[cell];
        uint asked = word & kAllPixels;
        uint fresh = asked & ~UintArray(table.traced).at[cell];
        UintArray(table.traced).at[cell] = asked;
        CellSpan span = cellSpan(at, table);
        if (push.round == 0u) {
            farthest = max(farthest, farthestOfCell(span, word >> kOwnPixels));
        }
        while (fresh != 0u) {
            int bit = findLSB(fresh);
            fresh &= fresh - 1u;
            UintArray(table.tileRays).at[index * kTilePixels + found.rayCount] =
                pixelIndex(span.first + ivec2(bit, bit >> 2) % int(kGlowCell));
            ++found.rayCount;
        }
    }
    if (push.round == 0u) {
        listPanes(tileBundle(index, farthest, table), table, found);
    }
    GlowTileArray(table.tiles).at[index] = found;
}
