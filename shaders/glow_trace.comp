// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The glow along the rays that a round chose. One group a tile.
#version 460
#extension GL_GOOGLE_include_directive : require

// glslang 12 crashes while it spreads `precise` through this program. Nothing here needs it: media
// nearer to each other than kMediaGap are one run.
#define precise

#define NIGHTCITY_KEEP_TABLES
#include "glow_along_ray.glsl"

layout(local_size_x = kTraceGroup) in;

void main() {
    keepTables();
    keepNearTable();
    GlowTable table = glowTable;
    uint tile = tileOfGroup(gl_WorkGroupID.x, table);
    if (gl_WorkGroupID.x >= table.columnTiles * table.rowTiles) {
        return;
    }
    uint rays = GlowTileArray(table.tiles).at[tile].rayCount;
    for (uint slot = gl_LocalInvocationIndex; slot < rays; slot += kTraceGroup) {
        uint index = UintArray(table.tileRays).at[tile * kTilePixels + slot];
        Ray ray = cameraRay(pixelOf(push.firstPixel + index), push.sampleIndex);
        float scale = length(ray.direction);
        float depth = SurfaceRecordArray(frameTable.surfaces).at[index].depth;
        GlowLedger ledger;
        GlowSampleArray(table.samples).at[index] = glowAlongRay(
            Ray(ray.origin, ray.direction / scale), depth * scale, tile, table, ledger);
        if (kLedger) {
            GlowLedgerArray(table.ledger).at[index] = ledger;
        }
    }
}
