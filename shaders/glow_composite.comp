// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Glow and transmittance of every pixel of a band from the rays of its cell, added to the
// images. One thread a cell.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "glow_ledger.glsl"
#include "image_sums.glsl"

layout(local_size_x = kGroupSize) in;

const bool kLedger = (kAovs & kLedgerAovs) != 0u;

void composite(ivec2 at, vec4 value) {
    uint index = pixelIndex(at);
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
    uint asked = UintArray(table.cells).at[index];
    uint own = asked >> kOwnPixels;
    CellSpan span = cellSpan(cell, table);
    // All ways for all cells: a device that does not skip branches then stores each pixel once.
    GlowPatch patch_ = glowPatch(cell, table);
    GlowQuarters quarters = glowQuarters(cell, table);
    bool hasHaze = own != 1u || patch_.isWhole;  // none: glow_refine.comp
    float cellError = 0.0;
    if (kLedger && hasHaze && (own == 1u || own == kEvenPixels)) {
        cellError = errorInCell(span.first, own == kEvenPixels, patch_, quarters, table);
    }
    for (int y = 0; y < int(kGlowCell); ++y) {
        vec4 down = cubicWeights(float(y) / float(kGlowCell));
        for (int x = 0; x < int(kGlowCell); ++x) {
            ivec2 at = span.first + ivec2(x, y);
            if (at.x >= int(frameTable.width) || at.y >= int(table.rows)) {
                continue;
            }
            vec4 value = vec4(0.0);
            float error = cellError;
            if (own == 1u) {
                if (hasHaze) {
                    value = inPatch(patch_, cubicWeights(float(x) / float(kGlowCell)), down);
                }
            } else if (own == kEvenPixels) {
                value = inQuarters(quarters, parabolaWeights(x), parabolaWeights(y));
            } else if ((own & bitOf(at)) != 0u) {
                value = valueAt(at, table);
            } else {
                value = straightInQuarter(quarters, x, y);
                if (kLedger) {
                    error = errorInQuarter(span.first, x, y, quarters, table);
                }
            }
            value = max(value, vec4(0.0));  // a cubic may fall below
            composite(at, value);
            if (kLedger) {
                GlowLedger ledger = ledgerAt(at, table);
                error = (own & bitOf(at)) != 0u && hasHaze ? ledger.error : error;
                float cost = (asked & bitOf(at)) != 0u ? ledger.cost : 0.0;
                addLedger(pixelIndex(at), value.rgb, error, cost);
            }
        }
    }
}
