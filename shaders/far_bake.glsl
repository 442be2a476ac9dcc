// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What the passes of the bake share: one work group a brick.
#ifndef NIGHTCITY_SHADERS_FAR_BAKE_GLSL
#define NIGHTCITY_SHADERS_FAR_BAKE_GLSL

#include "far_field.glsl"
#include "far_bake.h"
#include "transport/near_far_split.h"

layout(constant_id = NIGHTCITY_CONSTANT_FAR_EMITTER) const uint kFarEmitter = kEmitterPane;
layout(constant_id = NIGHTCITY_CONSTANT_FAR_VISIBILITY) const uint kFarVisibility = 1u;

NIGHTCITY_ARRAY(FarLightArray, FarLight)
NIGHTCITY_ARRAY(FarEntryArray, FarEntry)
NIGHTCITY_ARRAY(Uvec3Array, uvec3)
NIGHTCITY_ARRAY(Uvec2Array, uvec2)

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer FarBakeReference {
    FarBakeTable table;
};

// The tables of the pass, kept at hand (addresses.glsl): the bake has no frame.
FarBakeTable bakeTable;
FarFieldTable bakedField;

void keepBakeTables() {
    keepSceneTable();
    bakeTable = FarBakeReference(push.frame).table;
    bakedField = FarFieldReference(bakeTable.field).table;
}

const uint kBrickSide = kBrickSteps + 1u;  // nodes

// Of the batch, and of all.
uint groupInBatch() {
    return gl_WorkGroupID.x;
}
uint groupBrick() {
    return push.firstPixel + gl_WorkGroupID.x;
}

// Entries of the brick: from the front of its part of the array, and from the end.
uvec2 entryCounts() {
    return Uvec2Array(bakeTable.entryCounts).at[groupInBatch()];
}

// Of those counted on from the front to the end.
uint entryAt(uint number, uvec2 counts) {
    uint skipped = number < counts.x ? 0u : bakeTable.entryCapacity - counts.x - counts.y;
    return groupInBatch() * bakeTable.entryCapacity + skipped + number;
}

// m, from a window beyond which a brick holds its light as it is.
float splitRadius(FarFieldTable field, FarBrick brick) {
    return splitRadius(field.nearRadius, brickSpacing(field, brick), isBlurred(field, brick.scale));
}

// Whether a node is of no use to the haze around it: in a solid or below the ground, and in bricks
// that are not blurred outside the haze too (far_sides.comp).
bool isSolid(uint brick, uint node) {
    uint word = UintArray(bakeTable.sides).at[brick * kBrickSideWords + (node >> 5)];
    return (word >> (node & 31u) & 1u) != 0u;
}

// Of a node along each axis, from 0.
uvec3 nodePlace(uint node) {
    return uvec3(node, node / kBrickSide, node / (kBrickSide * kBrickSide)) % kBrickSide;
}

uint nodeAt(uvec3 place) {
    return (place.z * kBrickSide + place.y) * kBrickSide + place.x;
}

#endif
