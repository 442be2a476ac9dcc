// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The far part of the fluence on a grid (transport/near_far_split.h): a lattice of cubic
// bricks over the bounds of the media; bricks without haze are not there. Each brick
// has its own nodes, those on its faces included, at the spacing of its level, and a list of
// the media that overlap it. An address is a uvec2: low word, high word.
#ifndef NIGHTCITY_SHADERS_FAR_FIELD_H
#define NIGHTCITY_SHADERS_FAR_FIELD_H

#include "language.h"

NIGHTCITY_BEGIN

NIGHTCITY_CONST uint kBrickCells = 8u;  // along each side, at level 0
NIGHTCITY_CONST uint kBrickLevels = 4u;  // at level l a brick has kBrickCells >> l cells a side

// Homogeneous haze in a box; equal neighbours are one where together they are a box.
struct FarMedium {
    vec3 lo;           // m
    float extinction;  // 1/m
    vec3 hi;           // m
    float scattering;  // 1/m
};

struct FarBrick {
    uint firstNode;    // into the nodes; x fastest, then y
    uint level;
    uint firstMedium;  // into the medium list
    uint mediumCount;  // at least 1
};

struct FarFieldTable {
    uvec2 index;       // uint a lattice cell, x fastest: into bricks, or kNone
    uvec2 bricks;      // FarBrick
    uvec2 nodes;       // uvec2 a node: red, green, blue as halves, in nodeUnit
    uvec2 media;       // FarMedium
    uvec2 mediumList;  // uint into media, those of one brick after another
    vec3 origin;       // m, lower corner of the lattice
    float brickSide;   // m
    uvec3 brickCounts; // of the lattice along each axis; 0: no haze
    float nodeUnit;    // W m^-2
    float nearRadius;  // m, R of near_far_split.h
};

NIGHTCITY_END

#endif
