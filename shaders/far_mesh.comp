// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What lies on the ways from the lights of a batch's entries to their brick: from which points of
// its mesh (far_mesh.glsl) a light is seen, one way each, from another part of the light than its
// neighbours', or from which of its corners; which places of a light large bricks look at over
// the roofs; and how much haze is between.
#version 460
#extension GL_GOOGLE_include_directive : require

#define NIGHTCITY_KEEP_TABLES
#include "far_hiding.glsl"
#include "far_mesh.glsl"
#include "far_window.glsl"

layout(local_size_x = kGroupSize) in;

const float kFarSides = 14.0;  // of a brick, from which on a light is far
const float kShortestWay = 1e-6;  // m

shared vec3 wayEnds[kWaySide * kWaySide * kWaySide];  // m, from the brick's centre

uint firstEntry() {
    return groupInBatch() * bakeTable.entryCapacity;
}

bool sees(vec3 place, uvec3 point, FarLight light, uint index, FarWindow window, vec3 origin) {
    // Points that are even along each axis are asked first, and must not all ask for one part.
    bool isEven = ((point.x | point.y | point.z) & 1u) == 0u;
    uvec3 parity = (isEven ? point >> 1u : point) & 1u;
    vec3 part = light.second == 0u
                    ? panePoint(window, parity.x | (parity.y ^ parity.z) << 1)
                    : partOf(index, parity.x | parity.y << 1 | parity.z << 2) - origin;
    bool isBelow = sceneTable.groundMaterial != kNone &&
                   origin.z + part.z < sceneTable.groundHeight;
    return !isBelow && !isHiddenByAny(part, place, origin);
}

bool meshSees(uint entry, uvec3 point, FarBrick brick, vec3 origin, FarFieldTable field) {
    uint index = FarEntryArray(bakeTable.entries).at[entry].light;
    FarLight light = FarLightArray(bakeTable.lights).at[index];
    FarWindow window = farWindow(entry, origin);
    float side = brickSide(field, brick);
    vec3 place = (vec3(point) / float(kMeshSide - 1u) - 0.5) * side;
    // Neighbouring bricks agree on what they share.
    uvec3 number = brick.cell * (kMeshSide - 1u) + point;
    place = askedPlace(place, light, window.centre, side / float(kBrickSteps));
    return sees(place, number, light, index, window, origin);
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

// The haze on the ways to a layer of places. Of a coarse brick, and from far away, the one in the
// middle speaks for its layer: over the roofs haze differs by height.
void findHaze(uint entry, uint layer, FarBrick brick, vec3 origin, FarFieldTable field) {
    uint index = FarEntryArray(bakeTable.entries).at[entry].light;
    vec3 from = FarLightArray(bakeTable.lights).at[index].centre - origin;
    uint first = layer * kWaySide * kWaySide;
    float middle = meanExtinction(from, wayEnds[first + kWaySide * kWaySide / 2u], origin, field);
    for (uint i = 0u; i < kWayWords; ++i) {
        FarEntryArray(bakeTable.entries).at[entry].ways[layer * kWayWords + i] =
            packHalf2x16(vec2(middle));
    }
    vec3 gap = abs(from) - 0.5 * brickSide(field, brick);
    bool isFar = max(gap.x, max(gap.y, gap.z)) > kFarSides * brickSide(field, brick);
    for (uint i = 0u; brick.scale == 0u && !isFar && i < kWayWords; ++i) {
        uvec2 pair = min(uvec2(2u * i, 2u * i + 1u), uvec2(kWaySide * kWaySide - 1u)) + first;
        FarEntryArray(bakeTable.entries).at[entry].ways[layer * kWayWords + i] =
            packHalf2x16(vec2(meanExtinction(from, wayEnds[pair.x], origin, field),
                              meanExtinction(from, wayEnds[pair.y], origin, field)));
    }
}

// A chunk of the brick's entries at a time: what the points of their meshes see, a word a layer, and
// the points that are still to be asked, numbered through the chunk. All threads ask at once, so
// that none waits for one whose points are known.
const uint kChunkEntries = 32u;
const uint kMeshPoints = kMeshSide * kMeshSide * kMeshSide;
shared uint meshWords[kChunkEntries * kMeshSide];
shared uint asked[kChunkEntries * kMeshPoints];
shared uint askedCount;

uvec3 meshPoint(uint number) {
    return uvec3(number, number / kMeshSide, number / (kMeshSide * kMeshSide)) % kMeshSide;
}

// `number`: of the entry in the chunk.
bool isSeenAt(uint number, uvec3 point) {
    uint word = meshWords[number * kMeshSide + point.z];
    return (word >> (point.y * kMeshSide + point.x) & 1u) != 0u;
}

void markSeen(uint number, uvec3 point) {
    atomicOr(meshWords[number * kMeshSide + point.z], 1u << (point.y * kMeshSide + point.x));
}

// Of eight points about one, even along each axis, those that see the light. Along axes where it is
// even itself they are the same ones twice.
uint evenPointsSeeing(uint number, uvec3 point) {
    uint seen = 0u;
    for (uint c = 0u; c < 8u; ++c) {
        uvec3 up = uvec3(c, c >> 1, c >> 2) & 1u;
        uvec3 odd = point & 1u;
        seen += isSeenAt(number, point - odd + 2u * odd * up) ? 1u : 0u;
    }
    return seen;
}

// Lists the points that are even along each axis; or of the others those between whose even
// neighbours light and shadow change. The rest sees what these see.
void listPoints(uint first, uint count, bool even) {
    if (gl_LocalInvocationIndex == 0u) {
        askedCount = 0u;
    }
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < count * kMeshPoints; i += kGroupSize) {
        uint number = i / kMeshPoints;
        uvec3 point = meshPoint(i % kMeshPoints);
        bool isEven = ((point.x | point.y | point.z) & 1u) == 0u;
        if (FarEntryArray(bakeTable.entries).at[first + number].faceCount != kMesh ||
            isEven != even) {
            continue;
        }
        uint seeing = even ? 1u : evenPointsSeeing(number, point);
        if (seeing == 8u) {
            markSeen(number, point);
        } else if (seeing > 0u) {
            asked[atomicAdd(askedCount, 1u)] = i;
        }
    }
    barrier();
}

void askPoints(uint first, FarBrick brick, vec3 origin, FarFieldTable field) {
    for (uint i = gl_LocalInvocationIndex; i < askedCount; i += kGroupSize) {
        uint number = asked[i] / kMeshPoints;
        uvec3 point = meshPoint(asked[i] % kMeshPoints);
        if (meshSees(first + number, point, brick, origin, field)) {
            markSeen(number, point);
        }
    }
    barrier();
}

bool seesNothing(uint number) {
    uint seen = 0u;
    for (uint layer = 0u; layer < kMeshSide; ++layer) {
        seen |= meshWords[number * kMeshSide + layer];
    }
    return seen == 0u;
}

void keepMesh(uint first, uint count) {
    for (uint i = gl_LocalInvocationIndex; i < count * kMeshSide; i += kGroupSize) {
        uint entry = first + i / kMeshSide;
        if (FarEntryArray(bakeTable.entries).at[entry].faceCount == kMesh) {
            FarEntryArray(bakeTable.entries).at[entry].face[i % kMeshSide] = meshWords[i];
        }
    }
}

void findHazeOfSeen(uint first, uint count, FarBrick brick, vec3 origin, FarFieldTable field) {
    for (uint i = gl_LocalInvocationIndex; i < count * kWaySide; i += kGroupSize) {
        uint number = i / kWaySide;
        uint entry = first + number;
        bool isHidden = FarEntryArray(bakeTable.entries).at[entry].faceCount == kMesh &&
                        seesNothing(number);
        if (FarEntryArray(bakeTable.entries).at[entry].extinction < 0.0 && !isHidden) {
            findHaze(entry, i % kWaySide, brick, origin, field);
        }
    }
}

void findChunk(uint first, uint count, FarBrick brick, vec3 origin, FarFieldTable field) {
    for (uint i = gl_LocalInvocationIndex; i < count * kMeshSide; i += kGroupSize) {
        meshWords[i] = 0u;
    }
    if (brick.scale == 0u) {
        listPoints(first, count, true);
        askPoints(first, brick, origin, field);
        listPoints(first, count, false);
        askPoints(first, brick, origin, field);
        keepMesh(first, count);
    }
    findHazeOfSeen(first, count, brick, origin, field);
    barrier();
}

void findSightAndHaze(uint entries, FarBrick brick, vec3 origin, FarFieldTable field) {
    for (uint done = 0u; done < entries; done += kChunkEntries) {
        findChunk(firstEntry() + done, min(entries - done, kChunkEntries), brick, origin, field);
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
    if (brick.scale > 0u && kFarVisibility != 0u) {
        findRoofPlaces(counts.x, origin);
    }
    findSightAndHaze(counts.x, brick, origin, field);
    findClusters(counts, brick, origin, field);
}
