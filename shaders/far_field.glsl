// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the far part of the fluence. A ray walks the lattice, from brick to brick where there
// are any (where the index is kNone is no haze), clips its part of each to the media of
// the brick, and samples between:
//
//     FarFieldTable field = farFieldTable;
//     uint index = brickAt(field, cell);
//     FarBrick brick = FarBrickArray(field.bricks).at[index];
//     vec3 place = (x - brickCorner(field, brick)) / brickSide(field, brick);
//     vec3 fluence = farSample(field, index, place).rgb;
#ifndef NIGHTCITY_SHADERS_FAR_FIELD_GLSL
#define NIGHTCITY_SHADERS_FAR_FIELD_GLSL

#include "addresses.glsl"
#include "far_field.h"

NIGHTCITY_ARRAY(FarBrickArray, FarBrick)
NIGHTCITY_ARRAY(FarMediumArray, FarMedium)

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer FarFieldReference {
    FarFieldTable table;
};
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer FarNodeArray {
    uvec2 at[];
};

#define farFieldTable FarFieldReference(sceneTable.farField).table

// m.
float brickSide(FarFieldTable field, FarBrick brick) {
    return field.cellSide * float(1u << brick.scale);
}

// m, from node to node.
float brickSpacing(FarFieldTable field, FarBrick brick) {
    return brickSide(field, brick) / float(kBrickSteps);
}

// Whether its nodes hold all of the fluence, not the far part alone.
bool isBlurred(FarFieldTable field, uint scale) {
    return scale >= field.blurredScale;
}

// Lower corner, m.
vec3 brickCorner(FarFieldTable field, FarBrick brick) {
    return field.origin + vec3(brick.cell) * field.cellSide;
}

// The index of a cell of the lattice, as FarFieldTable has it.
uint indexAt(FarFieldTable field, ivec3 cell) {
    ivec3 counts = ivec3(field.cellCounts);
    return UintArray(field.index).at[(cell.z * counts.y + cell.y) * counts.x + cell.x];
}

uint brickOfIndex(uint word) {
    return word == kNone ? kNone : word & ((1u << kScaleShift) - 1u);
}

// Into the bricks; kNone outside the lattice and where there is no haze.
uint brickAt(FarFieldTable field, ivec3 cell) {
    if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, ivec3(field.cellCounts)))) {
        return kNone;
    }
    return brickOfIndex(indexAt(field, cell));
}

// In nodeUnit.
vec4 farNode(FarFieldTable field, uint node) {
    uvec2 halves = FarNodeArray(field.nodes).at[node];
    return vec4(unpackHalf2x16(halves.x), unpackHalf2x16(halves.y));
}

// W m^-2 at a place of the brick, from (0, 0, 0) at its lower corner to (1, 1, 1): trilinear.
// rgb: fluence, a: its error as estimated.
vec4 farSample(FarFieldTable field, uint brick, vec3 place) {
    const uint side = kBrickSteps + 1u;
    vec3 grid = clamp(place, vec3(0.0), vec3(1.0)) * float(kBrickSteps);
    vec3 corner = min(floor(grid), vec3(float(kBrickSteps) - 1.0));
    vec3 t = grid - corner;
    uvec3 at = uvec3(corner);
    uint node = brick * kBrickNodes + (at.z * side + at.y) * side + at.x;
    vec4 low = mix(mix(farNode(field, node), farNode(field, node + 1u), t.x),
                   mix(farNode(field, node + side), farNode(field, node + side + 1u), t.x), t.y);
    node += side * side;
    vec4 high = mix(mix(farNode(field, node), farNode(field, node + 1u), t.x),
                    mix(farNode(field, node + side), farNode(field, node + side + 1u), t.x), t.y);
    return mix(low, high, t.z) * field.nodeUnit;
}

#endif
