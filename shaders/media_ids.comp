// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The first media box on each ray of the cells of kMixedCells. A few groups take
// them all.
#version 460
#extension GL_GOOGLE_include_directive : require

#define NIGHTCITY_KEEP_TABLES
#include "glow_cells.glsl"
#include "intersect.glsl"

layout(local_size_x = kGroupSize) in;

void main() {
    keepTables();
    GlowTable table = glowTable;
    const uint kPixels = kGlowCell * kGlowCell;
    uint count = kPixels * cellCount(kMixedCells, table);
    for (uint k = firstOfList(); k < count; k += kListGroups * kGroupSize) {
        ivec2 cell = cellAt(cellOfList(kMixedCells, k / kPixels, table), table);
        ivec2 at = cell * int(kGlowCell) + ivec2(k % kGlowCell, k / kGlowCell % kGlowCell);
        if (at.x < int(frameTable.width) && at.y < int(table.rows)) {
            uint pixel = pixelIndex(at);
            Ray ray = cameraRay(pixelOf(push.firstPixel + pixel), push.sampleIndex);
            RayProgressArray(frameTable.progress).at[pixel].firstMediaId =
                firstMediaId(ray, SurfaceRecordArray(frameTable.surfaces).at[pixel].depth);
        }
    }
}
