// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Glow and transmittance of every pixel of a band from the rays of its cell, added to the
// images. One thread a cell.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "glow_interpolation.glsl"
#include "image_sums.glsl"

layout(local_size_x = kGroupSize) in;

void composite(ivec2 at, vec4 value) {
    uint index = pixelIndex(at);
    value = max(value, vec4(0.0));  // a cubic may fall below
    int firstMediaId =
        isKept(kAovMediaId) ? RayProgressArray(frameTable.progress).at[index].firstMediaId : -1;
    addSample(index, SurfaceRecordArray(frameTable.surfaces).at[index], value.rgb, exp(-value.w),
              firstMediaId);
}

// Of a cell whose corners alone are known.
void compositePlain(ivec2 cell, GlowTable table) {
    GlowPatch points = glowPatch(cell, table);
    ivec2 first = cell * int(kGlowCell);
    ivec2 end = min(first + int(kGlowCell), ivec2(frameTable.width, table.rows)) - first;
    for (int y = 0; y < end.y; ++y) {
        vec4 down = cubicWeights(float(y) / float(kGlowCell));
        for (int x = 0; x < end.x; ++x) {
            composite(first + ivec2(x, y),
                      points.isWhole
                          ? inPatch(points, cubicWeights(float(x) / float(kGlowCell)), down)
                          : vec4(0.0));  // no haze: glow_refine.comp
        }
    }
}

void compositeQuarters(ivec2 cell, GlowTable table) {
    GlowQuarters points = glowQuarters(cell, table);
    ivec2 first = cell * int(kGlowCell);
    for (int y = 0; y < int(kGlowCell); ++y) {
        for (int x = 0; x < int(kGlowCell); ++x) {
            composite(first + ivec2(x, y),
                      inQuarters(points, parabolaWeights(x), parabolaWeights(y)));
        }
    }
}

// Between the corners of the quarter of a pixel.
vec4 straightInQuarter(ivec2 at, GlowTable table) {
    ivec2 low = at & ~1;
    ivec2 high = low + 2 * (at & 1);
    return 0.25 * (valueAt(low, table) + valueAt(high, table) +
                   valueAt(ivec2(low.x, high.y), table) + valueAt(ivec2(high.x, low.y), table));
}

void compositeMixed(ivec2 cell, uint own, GlowTable table) {
    ivec2 first = cell * int(kGlowCell);
    ivec2 end = min(first + int(kGlowCell), ivec2(frameTable.width, table.rows)) - first;
    for (int y = 0; y < end.y; ++y) {
        for (int x = 0; x < end.x; ++x) {
            ivec2 at = first + ivec2(x, y);
            composite(at, (own & bitOf(at)) != 0u ? valueAt(at, table)
                                                  : straightInQuarter(at, table));
        }
    }
}

void main() {
    GlowTable table = glowTable;
    uint index = gl_GlobalInvocationID.x;
    bool isComplete = UintArray(table.paneCounter).at[0] <= table.paneCapacity;
    if (index >= table.columnCells * table.rowCells || !isComplete) {
        return;
    }
    ivec2 cell = ivec2(index % table.columnCells, index / table.columnCells);
    if (!isKeptCell(cell, table)) {
        return;
    }
    uint own = UintArray(table.cells).at[index] >> kOwnPixels;
    if (own == 1u) {
        compositePlain(cell, table);
    } else if (own == kEvenPixels) {
        compositeQuarters(cell, table);
    } else {
        compositeMixed(cell, own, table);
    }
}
