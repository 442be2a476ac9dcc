// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds the windows of a batch's entries to the nodes of their brick, one upright column of
// nodes a thread. Sums are integers, so that their order does not matter, and what a window
// brought is taken away to the bit.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#include "far_column.glsl"
#include "far_mesh.glsl"

layout(local_size_x = kColumnThreads) in;

const uint kNodesALayer = kBrickSide * kBrickSide;

// W m^-2 per unit of the brick: of the new state of a window, less the old.
uvec3 inUnits(float perWatt, vec3 emission, vec3 baked) {
    // Below 2^31: a signed conversion is one instruction where an unsigned one is many.
    uvec3 sum = uvec3(ivec3(perWatt * emission + 0.5));
    return bakeTable.update == 0u ? sum : sum - uvec3(ivec3(perWatt * baked + 0.5));
}

// Of a light, from the nodes of a column.
float[kColumnNodes] seenShares(FarWindow window, Hidden hidden, MeshSight sight, MeshColumn mesh,
                               vec2 across) {
    bool isCluster = window.faceCount == kCluster;
    bool isMesh = window.faceCount == kMesh;
    vec2 ends = seenFromCorners(window.corners, across);
    float seen[kColumnNodes];
    [[unroll]] for (uint i = 0u; i < kColumnNodes; ++i) {
        float ofCluster = mix(ends.x, ends.y, float(i) / float(kBrickSteps));
        seen[i] = isCluster ? ofCluster
                  : isMesh  ? meshShare(sight, mesh, i)
                            : seenShare(hidden, i);
    }
    return seen;
}

void main() {
    FarFieldTable field = bakedField;
    FarBrick brick = FarBrickArray(field.bricks).at[groupBrick()];
    uint thread = min(gl_LocalInvocationIndex, kNodesALayer - 1u);
    Column column;
    column.spacing = brickSpacing(field, brick);
    column.halfSide = 0.5 * brickSide(field, brick);
    column.foot = column.spacing * vec3(nodePlace(thread)) - column.halfSide;
    vec3 origin = brickCorner(field, brick) + column.halfSide;
    column.isCoarse = brick.scale > 0u;
    column.exactHaze = exactHaze(brick, brickSide(field, brick));
    vec2 across = 0.5 * column.foot.xy / column.halfSide + 0.5;
    column.acrossX = betweenThree(across.x);
    column.acrossY = betweenThree(across.y);
    [[unroll]] for (uint i = 0u; kFarVisibility == 0u && i < kColumnNodes; ++i) {
        vec3 place = column.foot + vec3(0.0, 0.0, float(i) * column.spacing);
        column.ownHaze[i] = hazeAt(place, origin, brick, field);
    }
    MeshColumn mesh = meshColumn(thread);
    float perUnit = 1.0 / FloatArray(bakeTable.units).at[groupBrick()];
    uvec2 counts = entryCounts();
    uint entries = counts.x + counts.y;
    Uvec3Array sums = Uvec3Array(bakeTable.sums);
    uint firstNode = groupBrick() * kBrickNodes + thread;
    bool isThere = thread == gl_LocalInvocationIndex;

    uvec3 sum[kColumnNodes];
    [[unroll]] for (uint i = 0u; i < kColumnNodes; ++i) {
        sum[i] = uvec3(0u);
    }
    for (uint first = 0u; first < entries; first += gl_SubgroupSize) {
        uint count = min(gl_SubgroupSize, entries - first);
        uint mine = entryAt(first + min(gl_SubgroupInvocationID, count - 1u), counts);
        FarWindow read = farWindow(mine, origin);
        uint light = FarEntryArray(bakeTable.entries).at[mine].light;
        vec3 readEmission = Vec3Array(bakeTable.emission).at[light] * perUnit;
        vec3 readBaked = Vec3Array(bakeTable.baked).at[light] * perUnit;
        for (uint e = 0u; e < count; ++e) {
            FarWindow window = windowOfLane(read, e);
            uint entry = subgroupBroadcast(mine, e);
            Hidden hidden = hiddenFromColumn(entry, window, column, origin);
            if (hidesAllNodes(hidden)) {
                continue;
            }
            vec3 emission = subgroupBroadcast(readEmission, e);
            vec3 baked = subgroupBroadcast(readBaked, e);
            float seen[kColumnNodes] =
                seenShares(window, hidden, meshSight(entry, mesh), mesh, across);
            if (isQuick(window, column)) {
                QuickColumn quick = quickColumn(window, column, field);
                [[unroll]] for (uint i = 0u; i < kColumnNodes; ++i) {
                    sum[i] += inUnits(seen[i] * quickFluence(quick, column, i), emission, baked);
                }
                continue;
            }
            [[dont_unroll]] for (uint i = 0u; isThere && i < kColumnNodes; ++i) {
                vec3 place = column.foot + vec3(0.0, 0.0, float(i) * column.spacing);
                if (seen[i] > 0.0) {
                    float extinction = kFarVisibility == 0u ? column.ownHaze[i]
                                       : window.extinction >= 0.0
                                           ? window.extinction
                                           : meanExtinction(window, place, origin, field);
                    float perWatt = seen[i] * farFluencePerWatt(window, place, extinction, field);
                    sums.at[firstNode + i * kNodesALayer] += inUnits(perWatt, emission, baked);
                }
            }
        }
    }
    [[unroll]] for (uint i = 0u; i < kColumnNodes; ++i) {
        if (isThere) {
            sums.at[firstNode + i * kNodesALayer] += sum[i];
        }
    }
}
