// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What lies on the ways from the lights of a batch's entries to their brick: from which points of
// its mesh (far_mesh.glsl) a light is seen, one way each, from another part of the light than its
// neighbours', or from which of its corners; which places of a light large bricks look at over
// the roofs; and how much haze is between. All of an entry's ways are asked by one thread or few,
// so that no thread waits for others' lights.
#version 460
#extension GL_GOOGLE_include_directive : require

#define NIGHTCITY_KEEP_TABLES
#include "far_hiding.glsl"
#include "far_mesh.glsl"
#include "far_window.glsl"

layout(local_size_x = kGroupSize) in;

const float kShortestWay = 1e-6;  // m

shared vec3 wayEnds[kWaySide * kWaySide * kWaySide];  // m, from the brick's centre

uint firstEntry() {
    return groupInBatch() * bakeTable.entryCapacity;
}

bool sees(vec3 place, uvec3 point, FarLight light, uint index, FarWindow window, vec3 origin) {
    uvec3 parity = point & 1u;
    vec3 part = light.second == 0u
                    ? panePoint(window, parity.x | (parity.y ^ parity.z) << 1)
                    : partOf(index, parity.x | parity.y << 1 | parity.z << 2) - origin;
    bool isBelow = sceneTable.groundMaterial != kNone &&
                   origin.z + part.z < sceneTable.groundHeight;
    return !isBelow && !isHiddenByAny(part, place, origin);
}

// Of a row of points along x: threads side by side walk much the same ways.
uint rowSees(uint entry, uvec2 row, FarBrick brick, float side, vec3 origin) {
    uint index = FarEntryArray(bakeTable.entries).at[entry].light;
    FarLight light = FarLightArray(bakeTable.lights).at[index];
    FarWindow window = farWindow(entry, origin);
    uint word = 0u;
    for (uint i = 0u; i < kMeshSide; ++i) {
        uvec3 point = uvec3(i, row);
        vec3 place = (vec3(point) / float(kMeshSide - 1u) - 0.5) * side;
        // Neighbouring bricks agree on what they share.
        uvec3 number = brick.cell * (kMeshSide - 1u) + point;
        place = askedPlace(place, light, window.centre, side / float(kBrickSteps));
        word |= sees(place, number, light, index, window, origin) ? 1u << i : 0u;
    }
    return word;
}

// The nearest place in the brick's haze: what is found there goes on beyond it, so that the field
// has no kink at the border of the haze. From the brick's centre.
vec3 inHaze(vec3 place, vec3 origin, FarBrick brick, FarFieldTable field) {
    vec3 nearest = place;
    float least = 1e30;
    for (uint i = 0u; i < brick.mediumCount; ++i) {
        uint index = UintArray(field.mediumList).at[brick.firstMedium + i];
        FarMedium medium = MediaArray(field.media).at[index];
        vec3 inside = clamp(place, medium.lo - origin, medium.hi - origin);
        float distance = dot(inside - place, inside - place);
        if (distance < least) {
            least = distance;
            nearest = inside;
        }
    }
    return nearest;
}

// 1/m.
float meanExtinction(vec3 from, vec3 to, vec3 origin, FarFieldTable field) {
    return depthThroughMedia(from, to, origin, field) / max(length(to - from), kShortestWay);
}

// The haze on the ways to a layer of places. Of a coarse brick the one in the middle speaks for its
// layer: over the roofs haze differs by height.
void findHaze(uint entry, uint layer, FarBrick brick, vec3 origin, FarFieldTable field) {
    uint index = FarEntryArray(bakeTable.entries).at[entry].light;
    vec3 from = FarLightArray(bakeTable.lights).at[index].centre - origin;
    uint first = layer * kWaySide * kWaySide;
    float middle = meanExtinction(from, wayEnds[first + kWaySide * kWaySide / 2u], origin, field);
    for (uint i = 0u; i < kWayWords; ++i) {
        FarEntryArray(bakeTable.entries).at[entry].ways[layer * kWayWords + i] =
            packHalf2x16(vec2(middle));
    }
    for (uint i = 0u; brick.scale == 0u && i < kWayWords; ++i) {
        uvec2 pair = min(uvec2(2u * i, 2u * i + 1u), uvec2(kWaySide * kWaySide - 1u)) + first;
        FarEntryArray(bakeTable.entries).at[entry].ways[layer * kWayWords + i] =
            packHalf2x16(vec2(meanExtinction(from, wayEnds[pair.x], origin, field),
                              meanExtinction(from, wayEnds[pair.y], origin, field)));
    }
}

void findMesh(uint entries, FarBrick brick, vec3 origin, FarFieldTable field) {
    float side = brickSide(field, brick);
    for (uint i = gl_LocalInvocationIndex; i < entries * kMeshSide * kMeshSide; i += kGroupSize) {
        uint entry = firstEntry() + i / (kMeshSide * kMeshSide);
        if (FarEntryArray(bakeTable.entries).at[entry].faceCount == kMesh) {
            uvec2 row = uvec2(i, i / kMeshSide) % kMeshSide;
            uint bits = rowSees(entry, row, brick, side, origin);
            atomicOr(FarEntryArray(bakeTable.entries).at[entry].face[row.y],
                     bits << row.x * kMeshSide);
        }
    }
}

void findAllHaze(uint entries, FarBrick brick, vec3 origin, FarFieldTable field) {
    for (uint i = gl_LocalInvocationIndex; i < entries * kWaySide; i += kGroupSize) {
        uint entry = firstEntry() + i / kWaySide;
        if (FarEntryArray(bakeTable.entries).at[entry].extinction < 0.0) {
            findHaze(entry, i % kWaySide, brick, origin, field);
        }
    }
}

// Of each light, windows or their points that stand for it, a cell of the map of heights before their
// walls.
void findRoofPlaces(uint entries, vec3 origin) {
    for (uint i = gl_LocalInvocationIndex; i < entries * kRoofPlaces; i += kGroupSize) {
        uint entry = firstEntry() + i / kRoofPlaces;
        uint number = i % kRoofPlaces;
        uint index = FarEntryArray(bakeTable.entries).at[entry].light;
        FarLight light = FarLightArray(bakeTable.lights).at[index];
        vec3 place = light.second == 0u ? panePoint(farWindow(entry, origin), number)
                                        : partOf(index, number * 3u) - origin;
        if (kFarEmitter != kEmitterIsotropic) {
            place += bakeTable.heightCell * light.axis;
        }
        for (uint axis = 0u; axis < 3u; ++axis) {
            FarEntryArray(bakeTable.entries).at[entry].face[3u * number + axis] =
                floatBitsToUint(place[axis]);
        }
    }
}

void findClusters(uvec2 counts, FarBrick brick, vec3 origin, FarFieldTable field) {
    vec3 halfSides = vec3(0.5 * brickSide(field, brick));
    for (uint i = gl_LocalInvocationIndex; i < counts.y; i += kGroupSize) {
        uint entry = entryAt(counts.x + i, counts);
        uint index = FarEntryArray(bakeTable.entries).at[entry].light;
        uint seen = seenFromCorners(index, brick, origin, halfSides);
        FarEntryArray(bakeTable.entries).at[entry].face[0] = seen;
        if (seen != 0u && FarEntryArray(bakeTable.entries).at[entry].extinction < 0.0) {
            vec3 from = FarLightArray(bakeTable.lights).at[index].centre - origin;
            FarEntryArray(bakeTable.entries).at[entry].extinction =
                meanExtinction(from, vec3(0.0), origin, field);
        }
    }
}

void main() {
    keepBakeTables();
    FarFieldTable field = bakedField;
    FarBrick brick = FarBrickArray(field.bricks).at[groupBrick()];
    float side = brickSide(field, brick);
    vec3 origin = brickCorner(field, brick) + 0.5 * side;
    uint thread = gl_LocalInvocationIndex;
    if (thread < kWaySide * kWaySide * kWaySide) {
        uvec3 number = uvec3(thread, thread / kWaySide, thread / (kWaySide * kWaySide)) % kWaySide;
        vec3 place = (vec3(number) / float(kWaySide - 1u) - 0.5) * side;
        wayEnds[thread] = inHaze(place, origin, brick, field);
    }
    barrier();
    uvec2 counts = entryCounts();
    if (brick.scale == 0u) {
        findMesh(counts.x, brick, origin, field);
    } else if (kFarVisibility != 0u) {
        findRoofPlaces(counts.x, origin);
    }
    findAllHaze(counts.x, brick, origin, field);
    findClusters(counts, brick, origin, field);
}
