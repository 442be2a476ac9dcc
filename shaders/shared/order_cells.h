// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Light that was scattered or reflected before, on the bricks of the far field (far_field.h). It is
// smooth. A brick has cells, each with one value for all of its haze: order by order, places in a
// cell look along rays into the cells around them. In the end its nodes do so, every other one of
// the far field's, for all orders at once. An address is a uvec2: low word, high word.
#ifndef NIGHTCITY_SHADERS_ORDER_CELLS_H
#define NIGHTCITY_SHADERS_ORDER_CELLS_H

#include "far_field.h"

NIGHTCITY_BEGIN

NIGHTCITY_CONST uint kOrderSteps = kBrickSteps / 2u;  // from node to node along a brick's side
NIGHTCITY_CONST uint kOrderSide = kOrderSteps + 1u;
NIGHTCITY_CONST uint kOrderNodes = kOrderSide * kOrderSide * kOrderSide;  // of a brick
NIGHTCITY_CONST uint kCellSteps = kBrickSteps / 2u;  // cells along a brick's side
NIGHTCITY_CONST uint kOrderCells = kCellSteps * kCellSteps * kCellSteps;  // of a brick
NIGHTCITY_CONST uint kCellSides = 6u;    // that its surfaces may face: x, y, z, -x, -y, -z
NIGHTCITY_CONST uint kCellPlaces = 2u;   // of a cell, in its haze
NIGHTCITY_CONST uint kPlaceTrials = 8u;  // for each
NIGHTCITY_CONST uint kPlaceThreads = kOrderCells * kCellPlaces;  // a group: a brick
NIGHTCITY_CONST uint kNodeThreads = 128u;  // a group: a brick, at least kOrderNodes

// Specialization constant beside the model's of dispatch.h: kGatherFirst and so on.
#define NIGHTCITY_CONSTANT_GATHER 5
NIGHTCITY_CONST uint kGatherFirst = 0u;  // what comes straight from the windows
NIGHTCITY_CONST uint kGatherNext = 1u;   // of the order before
NIGHTCITY_CONST uint kGatherAll = 2u;    // of all orders

// Of the dispatches, PushConstants has the first brick (of far_near.comp the first group) and their
// number, in `round` the order that is gathered, and in `sampleIndex` how many rays a place sends (a
// node, a window).
struct FarOrdersTable {
    uvec2 field;       // FarFieldTable
    uvec2 bake;        // FarBakeTable
    uvec2 places;      // vec4 a place of the cells: m, and 1 where it lies in haze, else 0
    uvec2 nearEnergy;  // uvec3 a cell, in energyUnit: integral over it of what nodes do not hold
    uvec2 hazeVolume;  // float a cell, m^3; 0: without haze
    // vec3 a cell, W m^-2, fluence:
    uvec2 first;       // straight from the windows
    uvec2 even, odd;   // of the last even and odd order, from the second on
    uvec2 higher;      // of all orders from the second on, so far
    // vec3 a cell and each of kCellSides, W m^-2, irradiance; 0 where surfaces are dim:
    uvec2 evenSides, oddSides;  // as even and odd
    uvec2 higherSides;          // as higher
    uvec2 nodes;       // vec4 a node, W m^-2: the same of all orders, and 1; in a solid 0
    float energyUnit;  // W m
    uint windowCount;
    uint lastOrder;    // that was gathered
    float tail;        // of all that follow it, as a share of it
};

NIGHTCITY_END

#endif
