// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which nodes of a brick are of use to the haze around them and which are not: those in a solid
// (where the first face above is seen from behind) or below the ground, and, unless the brick is
// blurred, those outside all media. Above the haze windows may be seen over the roofs that the haze
// below never sees.
#version 460
#extension GL_GOOGLE_include_directive : require

#define NIGHTCITY_KEEP_TABLES
#include "far_places.glsl"

layout(local_size_x = kGroupSize) in;

shared uint solid[kBrickSideWords];
shared uint wholeBrick;

const uint kUndecided = 2u;

// Whether a node is of no use to the haze around it. One on a wall belongs to the air before it,
// one on a roof with no haze above it to nothing. Between the nodes of a large brick there may be
// whole streets of haze: there clear air speaks for it too.
bool isOutside(vec3 place, uint brickSide, bool isLarge, FarFieldTable field) {
    for (uint i = 0u; i < 8u; ++i) {
        vec3 near = place + 2.0 * kOnFace * (vec3(uvec3(i, i >> 1, i >> 2) & 1u) * 2.0 - 1.0);
        bool inSolid = brickSide == kUndecided ? isInSolid(near) : brickSide == 1u;
        if (!inSolid && (isLarge || isInHaze(near, field))) {
            return false;
        }
    }
    return true;
}

// One answer for all of the brick where no face and no ground meets it.
uint sideOfBrick(vec3 corner, float side) {
    vec3 halfSides = vec3(0.5 * side);
    float above = corner.z - sceneTable.groundHeight;
    if (sceneTable.groundMaterial != kNone && above < 0.0 && above + side >= 0.0) {
        return kUndecided;
    }
    Between between = betweenBoxAndBox(corner + halfSides, halfSides, vec3(0.0), halfSides);
    uint walk = 0u;
    if (nextOccluder(walk, between) != kNone) {
        return kUndecided;
    }
    return isInSolid(corner + halfSides) ? 1u : 0u;
}

void main() {
    keepBakeTables();
    uint thread = gl_LocalInvocationIndex;
    FarFieldTable field = bakedField;
    FarBrick brick = FarBrickArray(field.bricks).at[groupBrick()];
    vec3 corner = brickCorner(field, brick);
    if (thread < kBrickSideWords) {
        solid[thread] = 0u;
    }
    if (thread == 0u) {
        wholeBrick = sideOfBrick(corner, brickSide(field, brick));
    }
    barrier();
    float spacing = brickSpacing(field, brick);
    for (uint node = thread; node < kBrickNodes; node += kGroupSize) {
        vec3 place = corner + spacing * vec3(nodePlace(node));
        if (isOutside(place, wholeBrick, brick.scale > 0u, field)) {
            atomicOr(solid[node >> 5], 1u << (node & 31u));
        }
    }
    barrier();
    if (thread < kBrickSideWords) {
        UintArray(bakeTable.sides).at[groupBrick() * kBrickSideWords + thread] = solid[thread];
    }
}
