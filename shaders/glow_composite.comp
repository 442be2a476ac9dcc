// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Glow and transmittance of every pixel of a band from the rays of its cell, added to the
// images. One thread a cell of a list; a few groups take them all.
#version 460
#extension GL_GOOGLE_include_directive : require

#define NIGHTCITY_KEEP_TABLES
#include "glow_ledger.glsl"
#include "image_sums.glsl"

layout(local_size_x = kGroupSize) in;
layout(constant_id = NIGHTCITY_CONSTANT_LIST) const uint kList = kClearCells;

const bool kLedger = (kAovs & kLedgerAovs) != 0u;

void composite(ivec2 at, vec4 value) {
    uint index = pixelIndex(at);
    int firstMediaId =
        isKept(kAovMediaId) ? RayProgressArray(frameTable.progress).at[index].firstMediaId : -1;
    addSample(index, SurfaceRecordArray(frameTable.surfaces).at[index], value.rgb, exp(-value.w),
              firstMediaId);
}

// What the rays that a cell is interpolated from have found.
struct CellRays {
    GlowPatch patch_;       // of kSmoothCells
    GlowQuarters quarters;  // of kOtherCells
    float error;            // of pixels that are interpolated, where all of them are alike
};

CellRays raysOf(ivec2 cell, uint own, GlowTable table) {
    CellRays rays;
    rays.error = 0.0;
    ivec2 first = cellSpan(cell, table).first;
    if (kList == kSmoothCells) {
        rays.patch_ = wholePatch(cell, table);
        if (kLedger) {
            rays.error = errorInPatch(first, rays.patch_, table);
        }
    } else if (kList == kOtherCells) {
        rays.quarters = glowQuarters(cell, table);
        if (kLedger && own == kEvenPixels) {
            rays.error = errorInQuarters(first, rays.quarters, table);
        }
    }
    return rays;
}

// Of pixel (x, y) of a cell, the pixel `at` of the band. `error`: as GlowLedger has it.
vec4 glowAt(CellRays rays, uint own, int x, int y, ivec2 at, GlowTable table, out float error) {
    error = rays.error;
    if (kList == kClearCells) {
        return vec4(0.0);
    }
    if (kList == kSmoothCells) {
        return inPatch(rays.patch_, cubicWeights(float(x) / float(kGlowCell)),
                       cubicWeights(float(y) / float(kGlowCell)));
    }
    // All ways for all cells: a device that does not skip branches then stores each pixel once.
    if (own == kEvenPixels) {
        return inQuarters(rays.quarters, parabolaWeights(x), parabolaWeights(y));
    }
    if ((own & bitOf(at)) != 0u) {
        return valueAt(at, table);
    }
    if (kLedger) {
        error = errorInQuarter(at - ivec2(x, y), x, y, rays.quarters, table);
    }
    return straightInQuarter(rays.quarters, x, y);
}

void compositeCell(uint index, GlowTable table) {
    ivec2 cell = cellAt(index, table);
    uint asked = UintArray(table.cells).at[index];
    uint own = asked >> kOwnPixels;
    CellRays rays = raysOf(cell, own, table);
    for (int y = 0; y < int(kGlowCell); ++y) {
        for (int x = 0; x < int(kGlowCell); ++x) {
            ivec2 at = cell * int(kGlowCell) + ivec2(x, y);
            if (kList == kOtherCells &&
                (at.x >= int(frameTable.width) || at.y >= int(table.rows))) {
                continue;
            }
            float error;
            vec4 found = glowAt(rays, own, x, y, at, table, error);
            vec4 value = max(found, vec4(0.0));  // a cubic may fall below
            composite(at, value);
            if (kLedger) {
                GlowLedger ledger = ledgerAt(at, table);
                bool isOwn = kList != kClearCells && (own & bitOf(at)) != 0u;
                float cost = (asked & bitOf(at)) != 0u ? ledger.cost : 0.0;
                addLedger(pixelIndex(at), value.rgb, isOwn ? ledger.error : error, cost);
            }
        }
    }
}

void main() {
    keepTables();
    GlowTable table = glowTable;
    if (UintArray(table.paneCounter).at[0] > table.paneCapacity) {
        return;  // the host makes room and starts anew
    }
    uint count = cellCount(kList, table);
    for (uint k = firstOfList(); k < count; k += kListGroups * kGroupSize) {
        compositeCell(cellOfList(kList, k, table), table);
    }
}
