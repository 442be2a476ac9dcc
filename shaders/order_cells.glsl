// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The cells that hold the light of higher orders (shared/order_cells.h).
#ifndef NIGHTCITY_SHADERS_ORDER_CELLS_GLSL
#define NIGHTCITY_SHADERS_ORDER_CELLS_GLSL

#include "far_field.glsl"
#include "order_cells.h"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer FarOrdersReference {
    FarOrdersTable table;
};

// Of the pass, kept at hand (addresses.glsl).
FarOrdersTable ordersTable;
FarFieldTable ordersField;

void keepOrdersTables() {
    keepSceneTable();
    ordersTable = FarOrdersReference(push.frame).table;
    ordersField = FarFieldReference(ordersTable.field).table;
}

// Fluence of an order, vec3 a cell.
uvec2 cellsOfOrder(uint order) {
    return order == 1u ? ordersTable.first
                       : (order & 1u) == 0u ? ordersTable.even : ordersTable.odd;
}

// Irradiance of an order from the second on, vec3 a cell and side.
uvec2 sidesOfOrder(uint order) {
    return (order & 1u) == 0u ? ordersTable.evenSides : ordersTable.oddSides;
}

uint orderBrick() {
    return push.firstPixel + gl_WorkGroupID.x;
}

// Of a node in its brick, along each axis, from 0.
uvec3 orderNodePlace(uint node) {
    return uvec3(node, node / kOrderSide, node / (kOrderSide * kOrderSide)) % kOrderSide;
}

// Of a cube.
uvec3 cornerOf(uint number) {
    return uvec3(number, number >> 1, number >> 2) & 1u;
}

// Of a cell in its brick.
uvec3 orderCellPlace(uint cell) {
    return uvec3(cell, cell / kCellSteps, cell / (kCellSteps * kCellSteps)) % kCellSteps;
}

// m, of a brick's cells.
float cellSideOf(FarFieldTable field, uint scale) {
    return field.cellSide / float(kCellSteps) * float(1u << scale);
}

// The cell about a place, kNone where no brick is; `side`: its, m, or as it would be of the smallest
// bricks.
uint cellAbout(vec3 place, out float side) {
    FarFieldTable field = ordersField;
    vec3 at = (place - field.origin) / field.cellSide;
    ivec3 cell = ivec3(floor(at));
    side = cellSideOf(field, 0u);
    if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, ivec3(field.cellCounts)))) {
        return kNone;
    }
    uint word = indexAt(field, cell);
    if (word == kNone) {
        return kNone;
    }
    uint scale = word >> kScaleShift;
    side = cellSideOf(field, scale);
    vec3 corner = vec3(cell >> scale << scale);
    uvec3 inBrick = min(uvec3((at - corner) * (float(kCellSteps) / float(1u << scale))),
                        uvec3(kCellSteps - 1u));
    return brickOfIndex(word) * kOrderCells +
           (inBrick.z * kCellSteps + inBrick.y) * kCellSteps + inBrick.x;
}

#endif
