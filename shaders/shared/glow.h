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

NIGHTCITY_CONST uint kGlowCell = 4u;    // pixels a side of a cell; bit 4 row + column of a mask
NIGHTCITY_CONST uint kGlowRounds = 3u;  // of choosing rays and integrating along them

// A window as its near part is integrated (transport/near_window.h); one a window.
struct NearPane {
    vec3 centre;    // m
    float halfU;    // m, half side along uAxis; of a sphere the radius
    vec3 uAxis;     // unit vectors; their cross product points outward
    float halfV;
    vec3 vAxis;
    uint flags;     // of the Window
    vec3 radiance;  // W m^-2 sr^-1 when lit; of a sphere the intensity, W sr^-1
    uint reserved;  // 0
};

// The panes whose half balls of the near radius touch cell c of a lattice are
// cellPanes[cellStart[c]] up to cellPanes[cellStart[c + 1]], exclusive, ascending.
struct NearTable {
    uvec2 panes;      // NearPane
    uvec2 cellStart;  // uint, one more than lattice cells; x fastest
    uvec2 cellPanes;  // uint into panes
    vec3 origin;      // m, lower corner of the lattice
    float side;       // m, of a cell
    uvec3 counts;     // cells along each axis
    float radius;     // m, R of transport/near_far_split.h
};

// What is found along one ray.
struct GlowSample {
    vec3 glow;      // W m^-2 sr^-1
    float depth;    // optical, of all haze before the surface
};

// Rays chosen in one round: VkDispatchIndirectCommand, then their number.
struct GlowRound {
    uint groups, one, alsoOne;
    uint count;
};

// Of a band: whole rows of the frame, the first a multiple of kGlowCell.
struct GlowTable {
    uvec2 samples;      // GlowSample, one a pixel of the band
    uvec2 cells;        // uint a cell, row by row: low half which of its pixels are integrated
                        // along their rays, high half which of those are its own
    uvec2 lists;        // uint, capacity a round: pixels of the band
    uvec2 rounds;       // GlowRound, kGlowRounds of them
    uint capacity;      // pixels
    uint rows;          // pixels, of the band
    uint columnCells;   // cells in a row
    uint rowCells;      // cells in a column
    uint firstKeptCell; // rows of cells whose pixels are kept: the others serve as neighbours
    uint keptCells;
    uint firstRow;      // of the band in the frame
    uint everyPixel;    // 1: nothing is interpolated
    float tolerance;    // relative
};

NIGHTCITY_END

#endif
