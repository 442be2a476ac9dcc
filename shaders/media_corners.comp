// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The media box that the ray of each cell's first pixel meets first, whatever surfaces hide. One
// thread a cell.
#version 460
#extension GL_GOOGLE_include_directive : require

#define NIGHTCITY_KEEP_TABLES
#include "glow_cells.glsl"
#include "haze_walk.glsl"

layout(local_size_x = kGroupSize) in;

NIGHTCITY_ARRAY(MediumSeenArray, MediumSeen)

const float kBeyondAll = 1e10;  // m
const uint kHashFactor = 16777619u;  // of Fowler, Noll and Vo's hash
const float kBesideSlack = 1e-3;  // m: more than float loses

// From the bounds of all media on.
HazeWalk walkInBounds(Ray ray) {
    HazeWalk walk = walkOf(sceneTable.mediaPlanes, ray, 0.0);
    if (sceneTable.mediaNodes != uvec2(0)) {
        BoxNode bounds = BoxNodeArray(sceneTable.mediaNodes).at[0];
        boxInterval(ray.origin, ray.direction, walk.inverse, bounds.lo, bounds.hi, kBeyondAll,
                    walk.at, walk.end);
    }
    return walk;
}

// On which side of a box the stretch up to `end` lies that a walk is at: 1 to 6; 0: on none.
uint sideOf(HazeWalk walk, float end, MediaBox box) {
    vec3 a = walk.origin + walk.at * walk.direction;
    vec3 b = walk.origin + end * walk.direction;
    bvec3 above = greaterThan(min(a, b), box.hi + kBesideSlack);
    bvec3 below = lessThan(max(a, b), box.lo - kBesideSlack);
    uint side = 0u;
    for (int axis = 0; axis < 3; ++axis) {
        side = above[axis] ? 2u * uint(axis) + 1u : below[axis] ? 2u * uint(axis) + 2u : side;
    }
    return side;
}

MediumSeen firstMedium(Ray ray, uint cell) {
    HazeWalk walk = walkInBounds(ray);
    MediumSeen seen = MediumSeen(kNone, 0u);
    bool isUnsure = false;  // the ray passes a box closely: others may meet it
    while (walk.at < walk.end && seen.box == kNone) {
        float cellEnd;
        HazeLeaf leaf = leafAt(walk, cellEnd);
        seen.path = (seen.path ^ leaf.node) * kHashFactor;
        if (leaf.item != kNone) {
            MediaBox box = MediaBoxArray(sceneTable.mediaBoxes).at[leaf.item];
            float entry, exit;
            boxInterval(walk.origin, walk.direction, walk.inverse, box.lo, box.hi, cellEnd, entry,
                        exit);
            bool isMet = max(entry, walk.at) < exit;
            uint side = sideOf(walk, cellEnd, box);
            seen.box = isMet ? leaf.item : kNone;
            seen.path = (seen.path ^ (isMet ? 0u : side)) * kHashFactor;
            isUnsure = isUnsure || (!isMet && side == 0u);
        }
        walk.at = cellEnd;
    }
    seen.path = isUnsure ? ~cell : seen.path;
    return seen;
}

void main() {
    keepTables();
    GlowTable table = glowTable;
    uint index = gl_GlobalInvocationID.x;
    if (index >= table.columnCells * table.rowCells) {
        return;
    }
    ivec2 first = ivec2(index % table.columnCells, index / table.columnCells) * int(kGlowCell);
    Ray ray = cameraRay(pixelOf(push.firstPixel + pixelIndex(first)), push.sampleIndex);
    MediumSeenArray(table.mediaSeen).at[index] = firstMedium(ray, index);
}
