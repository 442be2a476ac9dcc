// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// How far the glow of a pixel may be off (GlowLedger), where it is interpolated between rays: the
// most of what these may be off, and what the ways to interpolate differ by.
#ifndef NIGHTCITY_SHADERS_GLOW_LEDGER_GLSL
#define NIGHTCITY_SHADERS_GLOW_LEDGER_GLSL

#include "glow_interpolation.glsl"

// Of bendOfPatch, bendOfQuarters and riseOfQuarter the shares that are not exceeded on 99 of 100
// pixels, measured against all rays in paper-4x4 (docs/accuracy.md).
const float kErrorOfBend = 0.5;
const float kErrorOfQuarterBend = 0.5;
const float kErrorOfRise = 0.5;

// Of the rays of a square of pixels, every `step` of them.
float largestError(ivec2 first, int side, int step, GlowTable table) {
    float most = 0.0;
    for (int y = 0; y <= side; y += step) {
        for (int x = 0; x <= side; x += step) {
            most = max(most, ledgerAt(first + ivec2(x, y), table).error);
        }
    }
    return most;
}

// Of pixels that are interpolated in a cell that sees one face.
float errorInPatch(ivec2 first, GlowPatch patch_, GlowTable table) {
    int side = int(kGlowCell);
    return largestError(first, side, side, table) +
           kErrorOfBend * bendOfPatch(patch_) * largest(patch_.at[5]);
}

float errorInQuarters(ivec2 first, GlowQuarters quarters, GlowTable table) {
    return largestError(first, int(kGlowCell), 2, table) +
           kErrorOfQuarterBend * bendOfQuarters(quarters) * largest(quarters.at[4]);
}

// Of pixels that are interpolated in the quarter that holds the pixel (x, y) of a cell.
float errorInQuarter(ivec2 first, int x, int y, GlowQuarters quarters, GlowTable table) {
    ivec2 quarter = ivec2(x, y) >> 1;
    return largestError(first + 2 * quarter, 2, 2, table) +
           kErrorOfRise * riseOfQuarter(quarters, 3 * quarter.y + quarter.x);
}

#endif
