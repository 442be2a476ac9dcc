// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What stands between a light and a brick.
#ifndef NIGHTCITY_SHADERS_FAR_HIDING_GLSL
#define NIGHTCITY_SHADERS_FAR_HIDING_GLSL

#include "convex_face.glsl"
#include "far_bake.glsl"
#include "occluders.glsl"

// An inner light of more faces than this is not asked about further: its windows are.
const uint kMostFacesAsked = 24u;
const float kLargestAsked = 16.0;  // m, half size of the lights that are asked about at all

// On which side of the face's plane all of a box is: 1 or -1; 0 on both.
int boxSide(OccluderFace face, vec3 toCorner, vec3 centre, vec3 halfSides) {
    float height = dot(face.normal, centre - toCorner);
    float reach = dot(abs(face.normal), halfSides);
    return height >= reach ? 1 : height <= -reach ? -1 : 0;
}

// Whether every straight way from the box about `light` to the box about the origin crosses the
// face: the planes through each corner of the one and each edge keep all of the other on
// their inner side.
bool hidesAll(OccluderFace face, vec3 origin, vec3 light, vec3 lightHalf, vec3 brickHalf) {
    vec3 corner = faceCorner(face, 0u, origin);
    int lightSide = boxSide(face, corner, light, lightHalf);
    if (lightSide == 0 || boxSide(face, corner, vec3(0.0), brickHalf) != -lightSide) {
        return false;
    }
    for (uint i = 0u; i < face.cornerCount; ++i) {
        vec3 next = faceCorner(face, i + 1u, origin);
        for (uint c = 0u; c < 8u; ++c) {
            vec3 side = vec3(uvec3(c, c >> 1, c >> 2) & 1u) * 2.0 - 1.0;
            vec3 from = light + side * lightHalf;
            vec3 plane = cross(corner - from, next - from) * float(lightSide);
            if (-dot(plane, from) + dot(abs(plane), brickHalf) > 0.0) {
                return false;
            }
        }
        corner = next;
    }
    return true;
}

// Whether one face hides all of the light from all of the brick. `way`: from the brick's
// centre to the light's.
bool isHidden(FarLight light, vec3 way, vec3 brickCentre, vec3 brickHalf) {
    if (kFarVisibility == 0u || any(greaterThan(light.reach, vec3(kLargestAsked)))) {
        return false;
    }
    Between between = betweenBoxAndBox(brickCentre, brickHalf, way, light.reach);
    uint walk = 0u;
    uint index = nextOccluder(walk, between);
    for (uint asked = 0u; index != kNone && asked < kMostFacesAsked; ++asked) {
        OccluderFace face = OccluderFaceArray(sceneTable.occluderFaces).at[index];
        if (hidesAll(face, brickCentre, way, light.reach, brickHalf)) {
            return true;
        }
        index = nextOccluder(walk, between);
    }
    return false;
}

// The wall behind a pane: whoever is behind it is behind the pane too, where nothing shines.
bool isBehindPane(FarLight light, OccluderFace face, vec3 toCorner, vec3 way) {
    return light.coneCos >= 0.0 && dot(face.normal, light.axis) > 0.99999 &&
           dot(light.axis, toCorner - way) <= 0.0;
}

// The faces between a window and the brick; false where one hides it from all of it.
bool findFaces(FarLight light, vec3 way, vec3 brickCentre, vec3 brickHalf, out FarEntry entry) {
    entry.faceCount = 0u;
    if (kFarVisibility == 0u) {
        return true;
    }
    Between between = betweenBoxAndBox(brickCentre, brickHalf, way, light.reach);
    uint walk = 0u;
    for (uint index = nextOccluder(walk, between); index != kNone;
         index = nextOccluder(walk, between)) {
        OccluderFace face = OccluderFaceArray(sceneTable.occluderFaces).at[index];
        if (isBehindPane(light, face, faceCorner(face, 0u, brickCentre), way)) {
            continue;
        }
        if (hidesAll(face, brickCentre, way, light.reach, brickHalf)) {
            return false;
        }
        if (entry.faceCount < kFarFaces) {
            entry.face[entry.faceCount++] = index;
        } else {
            entry.faceCount = kManyFaces;
        }
    }
    return true;
}

#endif
