// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The far part of the fluence on a grid (transport/near_far_split.h): a lattice of cubic
// cells over the bounds of the media, and cubic bricks of 1, 2, 4 ... cells a side, each at a
// multiple of its side; cells without haze have none. Each brick has its own kBrickNodes
// nodes, those on its faces included, and a list of the media that overlap it. An address is
// a uvec2: low word, high word.
#ifndef NIGHTCITY_SHADERS_FAR_FIELD_H
#define NIGHTCITY_SHADERS_FAR_FIELD_H

#include "language.h"

NIGHTCITY_BEGIN

NIGHTCITY_CONST uint kBrickSteps = 8u;   // from node to node along each side of a brick
NIGHTCITY_CONST uint kBrickNodes = (kBrickSteps + 1u) * (kBrickSteps + 1u) * (kBrickSteps + 1u);
NIGHTCITY_CONST uint kBrickScales = 6u;  // a brick of scale s is 1 << s lattice cells a side
NIGHTCITY_CONST uint kScaleShift = 28u;  // of the index: bricks are fewer than 1 << kScaleShift
NIGHTCITY_CONST float kLargestHalf = 65504.0f;

// Homogeneous haze in a box; equal neighbours are one where together they are a box.
struct FarMedium {
    vec3 lo;           // m
    float extinction;  // 1/m
    vec3 hi;           // m
    float scattering;  // 1/m
};

struct FarBrick {
    uvec3 cell;        // its lowest in the lattice, each a multiple of 1 << scale
    uint scale;        // below kBrickScales
    uint firstMedium;  // into the medium list
    uint mediumCount;  // at least 1
};

struct FarFieldTable {
    uvec2 index;       // uint a lattice cell, x fastest: the brick that holds it and above
                       // kScaleShift its scale, or kNone
    uvec2 bricks;      // FarBrick
    uvec2 nodes;       // uvec2 a node, kBrickNodes a brick: as halves, in nodeUnit, red, green and
                       // blue, and how far what is interpolated there may be off: an estimate
    uvec2 media;       // FarMedium
    uvec2 mediumList;  // uint into media, those of one brick after another
    vec3 origin;       // m, lower corner of the lattice
    float cellSide;    // m
    uvec3 cellCounts;  // of the lattice along each axis; 0: no haze
    float nodeUnit;    // W m^-2
    float nearRadius;  // m, R of near_far_split.h
    uint blurredScale; // from this scale on bricks hold the near parts too, blurred: at least 1
};

NIGHTCITY_END

#endif
