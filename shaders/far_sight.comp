// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which windows may light a brick, each with the faces that may stand between: asked once for
// the whole brick. Lights that face away, or that one convex face hides from all of the
// brick, end here. Also the unit of the brick's sums: whichever windows are on, they
// stay below 2^32.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "far_bake.glsl"
#include "far_hiding.glsl"

layout(local_size_x = kGroupSize) in;

const float kManyBricks = 3.0;  // sides of a brick, distance of a window with many faces between

// Lights still to be looked at. A round takes the last kGroupSize of them and puts
// back at most two for each: as deep as the tree is, no more than kFarStack are there.
shared uint stack[kFarStack];
shared uint stackSize;
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
float largestFluence(FarLight light, vec3 way, vec3 brickHalf, float nearRadius) {
    vec3 gap = max(abs(way) - brickHalf, vec3(0.0));
    // (1 - nearShare(y)) / y is at most 1.3815, and at most 1 / y; a pane brings at most 4 / 3
    // of its point from a side away, and no more than half the sphere from nearer.
    return 2.0 * light.power / (3.14159265 * max(dot(gap, gap), 0.25 * nearRadius * nearRadius));
}

// A light so small from here, with windows that face one way, is one point, seen from a brick
// that is as small from there: its sight is interpolated. From where the share of the near
// part ends.
bool isCluster(FarLight light, vec3 way, vec3 brickHalf, float nearRadius) {
    float gap = length(max(abs(way) - brickHalf, vec3(0.0)));
    float reach = length(light.reach);
    return max(reach, length(brickHalf)) <= bakeTable.spread * gap && gap >= nearRadius + reach &&
           (light.coneCos >= kClusterCos || kFarEmitter == kEmitterIsotropic);
}

// 1/m, the mean on the way to the brick; negative where nodes must ask themselves.
float extinctionOnTheWay(FarLight light, vec3 way, vec3 brickCentre, FarBrick brick,
                         bool cluster) {
    FarFieldTable field = bakedField;
    if (brick.mediumCount == 1u && light.medium != kNone &&
        UintArray(field.mediumList).at[brick.firstMedium] == light.medium) {
        return MediaArray(field.media).at[light.medium].extinction;
    }
    return cluster ? depthThroughMedia(way, vec3(0.0), brickCentre, field) / length(way) : -1.0;
}

void append(uint index, FarLight light, bool cluster, vec3 brickCentre, vec3 brickHalf,
            FarBrick brick, float nearRadius) {
    vec3 way = light.centre - brickCentre;
    FarEntry entry;
    if (!cluster && !findFaces(light, way, brickCentre, brickHalf, entry)) {
        return;
    }
    // Too many faces to list: sight from the corners will do where the window is far.
    cluster = cluster || (entry.faceCount == kManyFaces &&
                          isCluster(light, way, brickHalf, kManyBricks * 2.0 * brickHalf.x));
    if (cluster) {
        entry.faceCount = kCluster;
        entry.face[0] = seenFromCorners(index, brick, brickCentre, brickHalf);
        if (entry.face[0] == 0u) {
            return;
        }
    }
    entry.light = index;
    entry.extinction = extinctionOnTheWay(light, way, brickCentre, brick, cluster);
    float most = largestFluence(light, way, brickHalf, nearRadius);
    atomicAdd(bound, 1u + uint(most / bakeTable.boundUnit));
    if (!hasChanged(index)) {
        return;
    }
    uint slot = atomicAdd(UintArray(bakeTable.entryCounts).at[groupInBatch()], 1u);
    if (slot < bakeTable.entryCapacity) {
        FarEntryArray(bakeTable.entries).at[groupInBatch() * bakeTable.entryCapacity + slot] =
            entry;
    }
}

void main() {
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
        bound = 1u;
    }
    barrier();
    while (stackSize > 0u) {
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
            vec3 way = brickCentre - light.centre;
            if (!facesAway(light, way, brickHalf)) {
                bool cluster = !isWindow(light) &&
                               isCluster(light, way, brickHalf, field.nearRadius);
                if (cluster || isWindow(light)) {
                    append(index, light, cluster, brickCentre, brickHalf, brick,
                           field.nearRadius);
                } else if (!isHidden(light, -way, brickCentre, brickHalf)) {
                    uint slot = atomicAdd(stackSize, 2u);
                    stack[slot] = index + 1u;
                    stack[slot + 1u] = light.second;
                }
            }
        }
        barrier();
    }
    if (thread == 0u && bakeTable.update == 0u) {
        // Sums of at most 2^31, so that rounding has room.
        float most = float(bound) * bakeTable.boundUnit;
        FloatArray(bakeTable.units).at[groupBrick()] = exp2(ceil(log2(most)) - 31.0);
    }
}
