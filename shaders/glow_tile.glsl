// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The tiles of a band (shared/glow.h), each with the panes that its rays may meet.
#ifndef NIGHTCITY_SHADERS_GLOW_TILE_GLSL
#define NIGHTCITY_SHADERS_GLOW_TILE_GLSL

#include "glow_cells.glsl"
#include "near_tree.glsl"

NIGHTCITY_ARRAY(GlowTileArray, GlowTile)

// Even tiles first: a device that gives each of its cores a range of groups then gives each
// the same share of the city.
uint tileOfGroup(uint group, GlowTable table) {
    uint half_ = (table.columnTiles * table.rowTiles + 1u) / 2u;
    return group < half_ ? 2u * group : 2u * (group - half_) + 1u;
}

// Cells of a tile, row by row of the band: `last` is one of them.
CellSpan cellsOfTile(uint tile, GlowTable table) {
    ivec2 first = ivec2(tile % table.columnTiles, tile / table.columnTiles) * int(kTileCells);
    return CellSpan(first, min(first + int(kTileCells), ivec2(table.columnCells, table.rowCells)) - 1);
}

// The rays of a tile's pixels up to a depth.
RayBundle tileBundle(uint tile, float farthest, GlowTable table) {
    CellSpan cells = cellsOfTile(tile, table);
    ivec2 first = cells.first * int(kGlowCell);
    ivec2 last = min((cells.last + 1) * int(kGlowCell), ivec2(frameTable.width, table.rows)) - 1;
    uvec2 above = uvec2(0u, table.firstRow);
    return rayBundle(uvec2(first) + above, uvec2(last) + above, farthest);
}

#endif
