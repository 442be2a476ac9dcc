// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds the windows of a batch's entries to the nodes of their brick, one upright column of
// nodes a thread. Sums are integers, so that their order does not matter, and what a window
// brought is taken away to the bit.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#define NIGHTCITY_KEEP_TABLES
#include "far_column.glsl"
#include "far_mesh.glsl"
#include "far_roofs.glsl"

layout(local_size_x = kColumnThreads) in;

layout(constant_id = NIGHTCITY_CONSTANT_FAR_UPDATE) const uint kUpdate = 0u;

// Whether the part has entries of large bricks, which look over the roofs.
bool mayLookOverRoofs() {
    return kFarVisibility != 0u && (kPart == kSumCoarse || kPart == kSumFront);
}

const uint kNodesALayer = kBrickSide * kBrickSide;

// Columns of which some node is read: those in a solid take their light from the air beside them.
shared uint columns[kNodesALayer];
shared uint columnCount;

bool isInTheAir(uint column) {
    bool isThere = false;
    for (uint i = 0u; i < kBrickSide; ++i) {
        isThere = isThere || !isSolid(groupBrick(), column + i * kNodesALayer);
    }
    return isThere;
}

void findColumns() {
    if (gl_LocalInvocationIndex == 0u) {
        columnCount = 0u;
    }
    barrier();
    if (gl_LocalInvocationIndex < kNodesALayer && isInTheAir(gl_LocalInvocationIndex)) {
        columns[atomicAdd(columnCount, 1u)] = gl_LocalInvocationIndex;
    }
    barrier();
}

// What one lane reads of an entry.
struct ReadEntry {
    FarWindow window;
    uint entry;
    uint mesh[kMeshSide];
    vec3 places[kRoofPlaces];  // m, from the brick's centre: as FarEntry has them
    vec3 emission, baked;  // in units of the brick
};

// W m^-2 per unit of the brick: of the new state of a window, less the old.
uvec3 inUnits(float perWatt, vec3 emission, vec3 baked) {
    // Below 2^31: a signed conversion is one instruction where an unsigned one is many.
    uvec3 sum = uvec3(ivec3(perWatt * emission + 0.5));
    return kUpdate == 0u ? sum : sum - uvec3(ivec3(perWatt * baked + 0.5));
}

ReadEntry readEntry(uint entry, vec3 origin, float perUnit) {
    ReadEntry read;
    read.window = farWindow(entry, origin);
    read.entry = entry;
    [[unroll]] for (uint layer = 0u; layer < kMeshSide; ++layer) {
        read.mesh[layer] = FarEntryArray(bakeTable.entries).at[entry].face[layer];
    }
    [[unroll]] for (uint i = 0u; kPart != kSumFine && i < kRoofPlaces; ++i) {
        [[unroll]] for (uint axis = 0u; axis < 3u; ++axis) {
            read.places[i][axis] =
                uintBitsToFloat(FarEntryArray(bakeTable.entries).at[entry].face[3u * i + axis]);
        }
    }
    uint light = FarEntryArray(bakeTable.entries).at[entry].light;
    read.emission = Vec3Array(bakeTable.emission).at[light] * perUnit;
    read.baked = kUpdate == 0u ? vec3(0.0) : Vec3Array(bakeTable.baked).at[light] * perUnit;
    return read;
}

ReadEntry entryOfLane(ReadEntry mine, uint lane) {
    ReadEntry read;
    read.window = windowOfLane(mine.window, lane);
    read.entry = subgroupBroadcast(mine.entry, lane);
    [[unroll]] for (uint layer = 0u; layer < kMeshSide; ++layer) {
        read.mesh[layer] = subgroupBroadcast(mine.mesh[layer], lane);
    }
    [[unroll]] for (uint i = 0u; kPart != kSumFine && i < kRoofPlaces; ++i) {
        read.places[i] = subgroupBroadcast(mine.places[i], lane);
    }
    read.emission = subgroupBroadcast(mine.emission, lane);
    read.baked = subgroupBroadcast(mine.baked, lane);
    return read;
}

bool isMesh(ReadEntry read) {
    return kPart != kSumCoarse && read.window.faceCount == kMesh;
}

bool isOverRoofs(ReadEntry read) {
    return mayLookOverRoofs() && read.window.faceCount == kRoofs;
}

// Of the pane's four points.
bvec4 arePointsHidden(FarWindow window, vec3 origin) {
    return equal(hiddenByGround(window, origin).nodes, uvec4(kAllNodes));
}

// Whether sight is interpolated, or nothing stands between.
bool isSightKnown(ReadEntry read, vec3 origin) {
    return kPart == kSumClusters || kPart == kSumCoarse || isMesh(read) || isOverRoofs(read) ||
           (read.window.faceCount == 0u && !any(arePointsHidden(read.window, origin)));
}

// False where nothing of the light is seen.
bool isSeen(ReadEntry read, vec3 origin) {
    if (all(arePointsHidden(read.window, origin))) {
        return false;
    }
    if (kPart == kSumCoarse || isOverRoofs(read)) {
        return true;
    }
    uint seen = read.mesh[0];  // of a cluster its corners
    [[unroll]] for (uint layer = 1u; layer < kMeshSide && kPart != kSumClusters; ++layer) {
        seen |= read.mesh[layer];
    }
    return seen != 0u || (kPart != kSumClusters && !isMesh(read));
}

// Of a light whose sight is known, from the nodes of a column.
float[kColumnNodes] knownShares(ReadEntry read, MeshColumn mesh, Column column, vec3 origin) {
    float seen[kColumnNodes];
    if (isOverRoofs(read)) {
        uint turn = column.turn;
        vec3 from = turn < 2u ? (turn == 0u ? read.places[0] : read.places[1])
                              : (turn == 2u ? read.places[2] : read.places[3]);
        float lowest = lowestSeen(from, column.beside, column, origin);
        [[unroll]] for (uint i = 0u; i < kColumnNodes; ++i) {
            seen[i] = clamp(float(i) - lowest + 0.5, 0.0, 1.0);
        }
        return seen;
    }
    if (kPart == kSumClusters) {
        vec2 ends = seenFromCorners(read.window.corners, column.across);
        [[unroll]] for (uint i = 0u; i < kColumnNodes; ++i) {
            seen[i] = mix(ends.x, ends.y, float(i) / float(kBrickSteps));
        }
        return seen;
    }
    MeshSight sight = meshSight(read.mesh, mesh);
    [[unroll]] for (uint i = 0u; i < kColumnNodes; ++i) {
        seen[i] = isMesh(read) ? meshShare(sight, mesh, i) : 1.0;
    }
    return seen;
}

float[kColumnNodes] sharesBeyond(Hidden hidden) {
    float seen[kColumnNodes];
    [[unroll]] for (uint i = 0u; i < kColumnNodes; ++i) {
        seen[i] = seenShare(hidden, i);
    }
    return seen;
}

void addQuick(ReadEntry read, float seen[kColumnNodes], Column column, FarFieldTable field,
              inout uvec3 sum[kColumnNodes]) {
    QuickColumn quick = quickColumn(read.window, column);
    [[unroll]] for (uint i = 0u; i < kColumnNodes; ++i) {
        sum[i] += inUnits(seen[i] * quickFluence(quick, column, i), read.emission, read.baked);
    }
}

// To the sums in memory: which node is at hand is not known when the shader is compiled.
void addExact(ReadEntry read, float seen[kColumnNodes], Column column, uint firstNode, vec3 origin,
              FarFieldTable field) {
    FarWindow window = read.window;
    [[dont_unroll]] for (uint i = 0u; i < kColumnNodes; ++i) {
        vec3 place = column.foot + vec3(0.0, 0.0, float(i) * column.spacing);
        if (seen[i] > 0.0) {
            float extinction = kFarVisibility == 0u        ? column.ownHaze[i]
                               : window.extinction >= 0.0 ? window.extinction
                                                          : meanExtinction(window, place, origin, field);
            float perWatt = seen[i] * bakedFluencePerWatt(window, place, extinction, column.baked);
            Uvec3Array(bakeTable.sums).at[firstNode + i * kNodesALayer] +=
                inUnits(perWatt, read.emission, read.baked);
        }
    }
}

Column columnOf(uint thread, FarBrick brick, FarFieldTable field, vec3 origin) {
    Column column;
    column.spacing = brickSpacing(field, brick);
    column.halfSide = 0.5 * brickSide(field, brick);
    column.baked = bakedShare(field, brick);
    column.foot = column.spacing * vec3(nodePlace(thread)) - column.halfSide;
    column.isCoarse = brick.scale > 0u;
    column.exactHaze = exactHaze(brick, brickSide(field, brick));
    column.across = 0.5 * column.foot.xy / column.halfSide + 0.5;
    column.beside = column.foot.xy;
    column.turn = (nodePlace(thread).x & 1u) | (nodePlace(thread).y & 1u) << 1;
    column.acrossX = betweenThree(column.across.x);
    column.acrossY = betweenThree(column.across.y);
    [[unroll]] for (uint i = 0u; kFarVisibility == 0u && i < kColumnNodes; ++i) {
        vec3 place = column.foot + vec3(0.0, 0.0, float(i) * column.spacing);
        column.ownHaze[i] = hazeAt(place, origin, brick, field);
    }
    return column;
}

void main() {
    keepBakeTables();
    FarFieldTable field = bakedField;
    FarBrick brick = FarBrickArray(field.bricks).at[groupBrick()];
    if ((kPart == kSumFine && brick.scale > 0u) || (kPart == kSumCoarse && brick.scale == 0u)) {
        return;
    }
    findColumns();
    bool isThere = gl_LocalInvocationIndex < columnCount;
    if (subgroupAll(!isThere)) {
        return;
    }
    uint thread = columns[min(gl_LocalInvocationIndex, columnCount - 1u)];
    vec3 origin = brickCorner(field, brick) + 0.5 * brickSide(field, brick);
    Column column = columnOf(thread, brick, field, origin);
    if (mayLookOverRoofs()) {
        column.beside = besideWalls(column.foot.xy, column.foot.z + column.spacing, origin);
    }
    MeshColumn mesh = meshColumn(thread);
    float perUnit = 1.0 / FloatArray(bakeTable.units).at[groupBrick()];
    uvec2 counts = entryCounts();
    uint begin = kPart == kSumClusters ? counts.x : 0u;
    uint end = kPart == kSumClusters ? counts.x + counts.y : counts.x;
    uint firstNode = groupBrick() * kBrickNodes + thread;

    uvec3 sum[kColumnNodes];
    [[unroll]] for (uint i = 0u; i < kColumnNodes; ++i) {
        sum[i] = uvec3(0u);
    }
    for (uint first = begin; first < end; first += lanesAtOnce()) {
        uint number = min(first + gl_SubgroupInvocationID, end - 1u);
        ReadEntry mine = readEntry(entryAt(number, counts), origin, perUnit);
        bool isMine = first + gl_SubgroupInvocationID < end && isSeen(mine, origin);
        bool quick = isQuick(mine.window, column);
        uint known = lanesWhere(isMine && quick && isSightKnown(mine, origin));
        while (known != 0u) {
            ReadEntry read = entryOfLane(mine, takeLane(known));
            addQuick(read, knownShares(read, mesh, column, origin), column, field, sum);
        }
        if (kPart == kSumClusters || kPart == kSumCoarse) {
            continue;
        }
        uint hidden = lanesWhere(isMine && quick && !isSightKnown(mine, origin));
        while (hidden != 0u) {
            ReadEntry read = entryOfLane(mine, takeLane(hidden));
            Hidden nodes = hiddenFromColumn(read.entry, read.window, column, origin);
            if (!hidesAllNodes(nodes)) {
                addQuick(read, sharesBeyond(nodes), column, field, sum);
            }
        }
        uint exact = lanesWhere(isMine && !quick);
        while (exact != 0u) {
            ReadEntry read = entryOfLane(mine, takeLane(exact));
            Hidden nodes = hiddenFromColumn(read.entry, read.window, column, origin);
            float seen[kColumnNodes] = isSightKnown(read, origin)
                                               ? knownShares(read, mesh, column, origin)
                                               : sharesBeyond(nodes);
            if (isThere && !hidesAllNodes(nodes)) {
                addExact(read, seen, column, firstNode, origin, field);
            }
        }
    }
    [[unroll]] for (uint i = 0u; i < kColumnNodes; ++i) {
        if (isThere) {
            Uvec3Array(bakeTable.sums).at[firstNode + i * kNodesALayer] += sum[i];
        }
    }
}
