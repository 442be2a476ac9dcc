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
    CellSpan span = cellSpan(cell, table);
    // All ways for all cells: a device that does not skip branches then stores each pixel once.
    GlowPatch patch_ = glowPatch(cell, table);
    GlowQuarters quarters = glowQuarters(cell, table);
    for (int y = 0; y < int(kGlowCell); ++y) {
        vec4 down = cubicWeights(float(y) / float(kGlowCell));
        for (int x = 0; x < int(kGlowCell); ++x) {
            ivec2 at = span.first + ivec2(x, y);
            if (at.x >= int(frameTable.width) || at.y >= int(table.rows)) {
                continue;
            }
            vec4 value = vec4(0.0);  // no haze: glow_refine.comp
            if (own == 1u) {
                if (patch_.isWhole) {
                    value = inPatch(patch_, cubicWeights(float(x) / float(kGlowCell)), down);
                }
            } else if (own == kEvenPixels) {
                value = inQuarters(quarters, parabolaWeights(x), parabolaWeights(y));
            } else if ((own & bitOf(at)) != 0u) {
                value = valueAt(at, table);
            } else {
                value = straightInQuarter(quarters, x, y);
            }
            composite(at, value);
        }
    }
}
