// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// How a frame of --method field finds its glow. Glow is smooth on the screen where one
// plane is seen, so it is integrated along the rays of a lattice of pixels, kGlowCell apart,
// and of more pixels where that does not do; the others are interpolated from pixels that see
// the same plane. What a pixel gets depends on the lattice of the whole frame only.
// An address is a uvec2: low word, high word.
#ifndef NIGHTCITY_SHADERS_GLOW_H
#define NIGHTCITY_SHADERS_GLOW_H

#include "language.h"

NIGHTCITY_BEGIN

// Specialization constants of glow_trace.comp.
#define NIGHTCITY_CONSTANT_POINTS 0     // 1: some windows are points or spheres of light
#define NIGHTCITY_CONSTANT_CUT_ALL 1    // as isNearCut of transport/near_window.h has it
#define NIGHTCITY_CONSTANT_THIN_HAZE 2  // 1: as nearPiece of transport/near_window.h has it
#define NIGHTCITY_CONSTANT_LEDGER 3     // 1: a GlowLedger a ray is kept
#define NIGHTCITY_CONSTANT_NEAR_EMITTER 4  // kEmitterIsotropic and so on
// Of glow_refine.comp: kRefineEdges and so on. Of glow_composite.comp: the list of cells that it
// takes, and NIGHTCITY_CONSTANT_AOVS. A device that runs both sides of a branch then
// reads and computes for a cell only what cells of its kind need.
#define NIGHTCITY_CONSTANT_STEP 0
#define NIGHTCITY_CONSTANT_LIST 0

NIGHTCITY_CONST uint kGlowCell = 4u;    // pixels a side of a cell; bit 4 row + column of a mask
NIGHTCITY_CONST uint kGlowRounds = 3u;  // of choosing rays and integrating along them
NIGHTCITY_CONST uint kTileCells = 8u;   // cells a side of a tile, whose rays share a list of panes
NIGHTCITY_CONST uint kTilePixels = kTileCells * kTileCells * kGlowCell * kGlowCell;
NIGHTCITY_CONST uint kTraceGroup = 32u;  // threads of glow_trace.comp, a group a tile
NIGHTCITY_CONST uint kListGroups = 64u;  // of passes that take a list of cells; even
NIGHTCITY_CONST uint kTileGroup = 64u;  // threads of glow_tiles.comp, one a tile

// Lists of cells, but the last of those whose pixels are kept. The order within one is chance, and
// changes nothing.
NIGHTCITY_CONST uint kClearCells = 0u;   // that see one face, without haze before the corners
NIGHTCITY_CONST uint kHazyCells = 1u;    // that see one face, others
NIGHTCITY_CONST uint kSmoothCells = 2u;  // those of them that are interpolated by the corners
NIGHTCITY_CONST uint kOtherCells = 3u;   // with more rays of their own
NIGHTCITY_CONST uint kMixedCells = 4u;   // that may see several media first
NIGHTCITY_CONST uint kCellLists = 5u;

// What glow_refine.comp does: the last in the third round, the others in the second.
NIGHTCITY_CONST uint kRefineEdges = 0u;     // more rays for quarters that see several faces
NIGHTCITY_CONST uint kRefineSort = 1u;      // kClearCells and kHazyCells from all cells
NIGHTCITY_CONST uint kRefinePatches = 2u;   // corners of quarters for cells where glow is bent
NIGHTCITY_CONST uint kRefineQuarters = 3u;  // all pixels of cells where it is bent between these
NIGHTCITY_CONST uint kRefineSteps = 4u;

// A window as its near part is integrated (transport/near_window.h). What is said of
// points holds for all windows where the model's emitter is not the pane, and for spheres of light.
struct NearPane {
    vec3 centre;    // m
    float halfU;    // m, half side along uAxis; of a point the radius of its sphere, else 0
    vec3 uAxis;     // unit vectors; their cross product points outward
    float halfV;    // m; of a point how far behind its plane it shines
    vec3 vAxis;
    uint flags;     // of the Window
    vec3 radiance;  // W m^-2 sr^-1 when lit; of a point the largest intensity, W sr^-1
    float closeBy;  // m from the centre: a ray farther off passes no edge within kNearCutSides
};

struct NearTable {
    uvec2 panes;    // NearPane, of those windows alone whose near parts rays integrate
    uvec2 windows;  // uint: the window of each
    uvec2 tree;     // BoxNode over the part of each pane's ball of the near radius before it
    float radius;   // m, R of transport/near_far_split.h
};

// What is found along one ray.
struct GlowSample {
    vec3 glow;      // W m^-2 sr^-1
    float depth;    // optical, of all haze before the surface
};

// What is known of a sample besides.
struct GlowLedger {
    float error;  // W m^-2 sr^-1: how far the glow may be off, an estimate
    float cost;   // samples of the far field, and nodes of the integrals over near panes
};

// The media box that a ray meets first, whatever surfaces hide. Rays of equal `path` pass the same
// leaves of the tree of planes, and before the last the boxes of these on the same sides.
struct MediumSeen {
    uint box;   // into MediaBox, or kNone
    uint path;  // a hash
};

// Of kTileCells x kTileCells cells: its rays of this round, and the lit panes whose near parts
// they may meet: tilePanes[firstPane] and so on.
struct GlowTile {
    uint rayCount;
    uint firstPane;
    uint paneCount;
};

// Of a band: whole rows of the frame, the first a multiple of kGlowCell.
struct GlowTable {
    uvec2 samples;      // GlowSample, one a pixel of the band
    uvec2 ledger;       // GlowLedger, one a pixel of the band; 0 where none is kept
    uvec2 cells;        // uint a cell, row by row: low half which of its pixels are integrated
                        // along their rays, high half which of those are its own
    uvec2 traced;       // uint a cell: which of its pixels were integrated in earlier rounds
    uvec2 lists;        // uint: how many cells each of kCellLists holds, then of each list
                        // room for all cells
    uvec2 tiles;        // GlowTile, row by row
    uvec2 tileRays;     // uint, kTilePixels a tile: pixels of the band
    uvec2 tilePanes;    // uint, those of one tile after another: into NearTable.panes
    uvec2 mediaSeen;    // MediumSeen a cell: along the ray of its first pixel; 0 where no ids of
                        // media are asked for
    uvec2 paneCounter;  // uint: panes of all tiles; may be more than there is room for
    uint paneCapacity;
    uint rows;          // pixels, of the band
    uint columnCells;   // cells in a row
    uint rowCells;      // cells in a column
    uint columnTiles;   // tiles in a row
    uint rowTiles;      // tiles in a column
    uint firstKeptCell; // rows of cells whose pixels are kept: the others serve as neighbours
    uint keptCells;
    uint firstRow;      // of the band in the frame
    uint everyPixel;    // 1: nothing is interpolated
    float tolerance;    // relative
};

NIGHTCITY_END

#endif
