// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Chooses more rays where glow bends too much between those of the round before: push.round
// is 1 for the corners of a cell's quarters, 2 for all its pixels. One thread a cell.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "glow_interpolation.glsl"

layout(local_size_x = kGroupSize) in;

// Of the difference between a straight and a curved interpolation in the middle of a cell, the
// share that the curved one may still be off. Measured on streets and overviews.
const float kBendShare = 0.25;

bool differ(vec4 straight, vec4 curved, float tolerance) {
    vec4 apart = abs(straight - curved);
    return kBendShare * largest(apart) > tolerance * largest(curved);
}

bool isTooBent(ivec2 cell, GlowTable table) {
    GlowPatch points = glowPatch(cell, table);
    bvec4 hazy = greaterThan(vec4(points.at[5].w, points.at[6].w, points.at[9].w, points.at[10].w),
                             vec4(0.0));
    if (!any(hazy)) {
        return false;
    }
    if (!all(hazy) || !points.isWhole) {
        return true;
    }
    vec4 straight = straightWeights(0.5);
    vec4 cubic = cubicWeights(0.5);
    return differ(inPatch(points, straight, straight), inPatch(points, cubic, cubic),
                  table.tolerance);
}

bool areQuartersTooBent(ivec2 cell, GlowTable table) {
    GlowQuarters points = glowQuarters(cell, table);
    for (int k = 0; k < 9; ++k) {
        if ((points.at[k].w > 0.0) != (points.at[0].w > 0.0)) {
            return true;
        }
    }
    vec4 straight = 0.25 * (points.at[0] + points.at[2] + points.at[6] + points.at[8]);
    return differ(straight, points.at[4], 2.0 * table.tolerance);
}

void main() {
    GlowTable table = glowTable;
    uint index = gl_GlobalInvocationID.x;
    if (index >= table.columnCells * table.rowCells) {
        return;
    }
    ivec2 cell = ivec2(index % table.columnCells, index / table.columnCells);
    uint own = UintArray(table.cells).at[index] >> kOwnPixels;
    if (!isKeptCell(cell, table)) {
        return;
    }
    if (push.round == 1u) {
        if (own == 1u && isTooBent(cell, table)) {
            askForMore(cell, table);
        }
    } else if (own == kEvenPixels && areQuartersTooBent(cell, table)) {
        askForOwn(cell, kAllPixels, table);
    }
}
