// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The media that the pixels of a cell see first, where its corners go by the same path to the same
// box (MediumSeen): leaves, boxes and what lies on one side of a box are convex, so all rays between
// do too.
// Lists the others as kMixedCells. One thread a cell.
#version 460
#extension GL_GOOGLE_include_directive : require

#define NIGHTCITY_KEEP_TABLES
#include "box_interval.glsl"
#include "camera_ray.glsl"
#include "glow_cells.glsl"

layout(local_size_x = kGroupSize) in;

NIGHTCITY_ARRAY(MediumSeenArray, MediumSeen)

bool isSame(MediumSeen a, MediumSeen b) {
    return a.box == b.box && a.path == b.path;
}

bool isMixed(uint index, CellSpan span, GlowTable table) {
    if (isClipped(span)) {
        return true;
    }
    MediumSeenArray seen = MediumSeenArray(table.mediaSeen);
    MediumSeen first = seen.at[index];
    uint below = index + table.columnCells;
    return !(isSame(first, seen.at[index + 1u]) && isSame(first, seen.at[below]) &&
             isSame(first, seen.at[below + 1u]));
}

int idBefore(Ray ray, float depth, uint index) {
    if (index == kNone) {
        return -1;
    }
    MediaBox box = MediaBoxArray(sceneTable.mediaBoxes).at[index];
    float entry, exit;
    boxInterval(ray.origin, ray.direction, reciprocal(ray.direction), box.lo, box.hi, depth, entry,
                exit);
    return entry < exit ? box.mediaId : -1;
}

void main() {
    keepTables();
    GlowTable table = glowTable;
    uint index = gl_GlobalInvocationID.x;
    if (index >= table.columnCells * table.rowCells) {
        return;
    }
    CellSpan span =
        cellSpan(ivec2(index % table.columnCells, index / table.columnCells), table);
    if (isMixed(index, span, table)) {
        addToList(kMixedCells, index, table);
        return;
    }
    uint box = MediumSeenArray(table.mediaSeen).at[index].box;
    for (uint k = 0u; k < kGlowCell * kGlowCell; ++k) {
        uint pixel = pixelIndex(span.first + ivec2(k % kGlowCell, k / kGlowCell));
        Ray ray = cameraRay(pixelOf(push.firstPixel + pixel), push.sampleIndex);
        float depth = SurfaceRecordArray(frameTable.surfaces).at[pixel].depth;
        RayProgressArray(frameTable.progress).at[pixel].firstMediaId = idBefore(ray, depth, box);
    }
}
