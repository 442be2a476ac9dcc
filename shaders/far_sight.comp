// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which windows may light a brick, each with the faces that may stand between: asked once for
// the whole brick. Lights that face away, or that one convex face hides from all of the
// brick, end here. Also the unit of the brick's sums: whichever windows are on, they
// stay below 2^32.
#version 460
#extension GL_GOOGLE_include_directive : require

#define NIGHTCITY_KEEP_TABLES
#include "far_bake.glsl"
#include "far_hiding.glsl"

layout(local_size_x = kGroupSize) in;

const uint kLargestHiddenFrom = 1u; // scale of bricks that one face often hides from a light
const uint kMostWaiting = 4u * kGroupSize;  // windows

// Lights still to be looked at. A round takes the last kGroupSize of them and puts
// back at most two for each: as deep as the tree is, no more than kFarStack are there.
shared uint stack[kFarStack];
shared uint stackSize;
// Windows whose faces are still to be found: all threads do that at once, so that none waits for
// one that is still in the tree.
shared uint windows[kMostWaiting];
shared uint windowCount;
shared uint bound;  // of the sums, in boundUnit

bool hasChanged(uint light) {
    return (UintArray(bakeTable.changed).at[light >> 5] >> (light & 31u) & 1u) != 0u;
}

bool isWindow(FarLight light) {
    return light.second == 0u;
}

// Whether all of the brick is behind all panes of the light. `way`: from the light's centre
// to the brick's.
bool facesAway(FarLight light, vec3 way, vec3 brickHalf) {
    if (light.coneCos < 0.0) {
        return false;
    }
    if (isWindow(light)) {
        return dot(light.axis, way) + dot(abs(light.axis), brickHalf) <= 0.0;
    }
    float reach = length(light.reach) + length(brickHalf);
    float distance = length(way);
    if (distance <= reach) {
        return false;
    }
    // The angle to the axis, less the cone's, less that under which both bounds are seen,
    // is a right one or more: cos(angle) <= -sin(cone + seen).
    float coneSin = sqrt(1.0 - light.coneCos * light.coneCos);
    float seenSin = reach / distance;
    float seenCos = sqrt(1.0 - seenSin * seenSin);
    if (light.coneCos * seenCos - coneSin * seenSin <= 0.0) {
        return false;
    }
    float sum = coneSin * seenCos + light.coneCos * seenSin;
    return dot(light.axis, way) <= -sum * distance;
}

// No contribution of the window to a node of the brick is larger, W m^-2.
float largestFluence(FarLight light, vec3 way, vec3 brickHalf, float splitRadius) {
    vec3 gap = max(abs(way) - brickHalf, vec3(0.0));
    // farShare(y) / y is at most 1.3815, and at most 1 / y; blurredShare(y) / y at most 6.6 and
    // 2 / y; a pane brings at most 4 / 3 of its point from a side away, and no more than half
    // the sphere from nearer.
    return 2.0 * light.power / (3.14159265 * max(dot(gap, gap), 0.25 * splitRadius * splitRadius));
}

// Of the distance, the share that a light may be half as large as to be one point. What is far
// away is mostly hidden, and what a large brick says is less exact anyway.
float spreadAt(float gap, FarBrick brick) {
    float growth = max(1.0, gap / (kFullSpread * bakedField.nearRadius)) * float(1u << 2u * brick.scale);
    return min(bakeTable.spread * growth, max(bakeTable.spread, kLargestSpread));
}

// How a brick sees a light: window by window, as a point, or as one that its corners speak for.
const uint kSeenApart = 0u;
const uint kSeenAsPoint = 1u;
const uint kSeenFromCorners = 2u;

// A light so small from here, with windows that face one way, is one point: from where the share
// of the near part ends, or where nodes are farther apart than it is large. From a brick that
// is as small from there, its sight is interpolated.
uint howSeen(FarLight light, vec3 way, vec3 brickHalf, FarBrick brick) {
    if (isWindow(light) || (light.coneCos < kClusterCos && kFarEmitter != kEmitterIsotropic)) {
        return kSeenApart;
    }
    float gap = length(max(abs(way) - brickHalf, vec3(0.0)));
    float reach = length(light.reach);
    float spread = spreadAt(gap, brick);
    bool isFar = reach <= spread * gap && gap >= splitRadius(bakedField, brick) + reach;
    if (brick.scale == 0u && isFar && length(brickHalf) <= spread * gap) {
        return kSeenFromCorners;
    }
    bool isSmall = brick.scale >= kJoinedScale && bakeTable.spread > 0.0 &&
                   reach * kJoinedReach <= brickHalf.x;
    return brick.scale > 0u && (isFar || isSmall) ? kSeenAsPoint : kSeenApart;
}

// 1/m; negative where it differs from way to way. Without visibility it does not matter
// (ownHaze of far_column.glsl).
float extinctionOnTheWay(FarLight light, FarBrick brick) {
    if (kFarVisibility == 0u) {
        return 0.0;
    }
    FarFieldTable field = bakedField;
    bool isSame = brick.mediumCount == 1u && light.medium != kNone &&
                  UintArray(field.mediumList).at[brick.firstMedium] == light.medium;
    return isSame ? MediaArray(field.media).at[light.medium].extinction : -1.0;
}

// False where nothing of the light is seen.
bool findSight(FarLight light, uint how, vec3 brickCentre, vec3 brickHalf, FarBrick brick,
               out FarEntry entry) {
    if (how == kSeenFromCorners) {
        entry.faceCount = kCluster;
        return true;
    }
    if (brick.scale == 0u) {
        return findFaces(light, light.centre - brickCentre, brickCentre, brickHalf, entry);
    }
    entry.faceCount = kFarVisibility == 0u ? 0u : kRoofs;
    return true;
}

void append(uint index, FarLight light, uint how, vec3 brickCentre, vec3 brickHalf,
            FarBrick brick) {
    FarEntry entry;
    if (!findSight(light, how, brickCentre, brickHalf, brick, entry)) {
        return;
    }
    float most = largestFluence(light, light.centre - brickCentre, brickHalf,
                                splitRadius(bakedField, brick));
    atomicAdd(bound, 1u + uint(most / bakeTable.boundUnit));
    if (!hasChanged(index)) {
        return;
    }
    entry.light = index;
    entry.extinction = extinctionOnTheWay(light, brick);
    bool fromEnd = how == kSeenFromCorners;
    uint count = 2u * groupInBatch() + (fromEnd ? 1u : 0u);
    uint slot = atomicAdd(UintArray(bakeTable.entryCounts).at[count], 1u);
    if (slot < bakeTable.entryCapacity) {
        slot = fromEnd ? bakeTable.entryCapacity - 1u - slot : slot;
        FarEntryArray(bakeTable.entries).at[groupInBatch() * bakeTable.entryCapacity + slot] =
            entry;
    }
}

// A round of the walk: takes lights from the stack and puts back their children.
void lookIntoLights(vec3 brickCentre, vec3 brickHalf, FarBrick brick) {
    uint thread = gl_LocalInvocationIndex;
    uint taken = min(stackSize, kGroupSize);
    uint rest = stackSize - taken;
    uint index = thread < taken ? stack[rest + thread] : kNone;
    barrier();
    if (thread == 0u) {
        stackSize = rest;
    }
    barrier();
    if (index != kNone && (bakeTable.update == 0u || hasChanged(index))) {
        FarLight light = FarLightArray(bakeTable.lights).at[index];
        vec3 way = light.centre - brickCentre;
        if (!facesAway(light, -way, brickHalf)) {
            uint how = howSeen(light, way, brickHalf, brick);
            if (isWindow(light)) {
                windows[atomicAdd(windowCount, 1u)] = index;
            } else if (how != kSeenApart) {
                append(index, light, how, brickCentre, brickHalf, brick);
            } else if (brick.scale > kLargestHiddenFrom ||
                       !isHidden(light, way, brickCentre, brickHalf)) {
                uint slot = atomicAdd(stackSize, 2u);
                stack[slot] = index + 1u;
                stack[slot + 1u] = light.second;
            }
        }
    }
    barrier();
}

void appendWindow(uint index, vec3 brickCentre, vec3 brickHalf, FarBrick brick) {
    FarLight light = FarLightArray(bakeTable.lights).at[index];
    append(index, light, kSeenApart, brickCentre, brickHalf, brick);
}

void main() {
    keepBakeTables();
    uint thread = gl_LocalInvocationIndex;
    FarFieldTable field = bakedField;
    FarBrick brick = FarBrickArray(field.bricks).at[groupBrick()];
    vec3 brickHalf = vec3(0.5 * brickSide(field, brick));
    vec3 brickCentre = brickCorner(field, brick) + brickHalf;
    for (uint i = thread; i < bakeTable.rootCount; i += kGroupSize) {
        stack[i] = UintArray(bakeTable.roots).at[i];
    }
    if (thread == 0u) {
        stackSize = bakeTable.rootCount;
        windowCount = 0u;
        bound = 1u;
    }
    barrier();
    while (stackSize > 0u) {
        while (stackSize > 0u && windowCount <= kMostWaiting - kGroupSize) {
            lookIntoLights(brickCentre, brickHalf, brick);
        }
        for (uint i = thread; i < windowCount; i += kGroupSize) {
            appendWindow(windows[i], brickCentre, brickHalf, brick);
        }
        barrier();
        if (thread == 0u) {
            windowCount = 0u;
        }
        barrier();
    }
    if (thread == 0u && bakeTable.update == 0u) {
        // Sums of at most 2^31, so that rounding has room.
        float most = float(bound) * bakeTable.boundUnit;
        FloatArray(bakeTable.units).at[groupBrick()] = exp2(ceil(log2(most)) - 31.0);
    }
}
