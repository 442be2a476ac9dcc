// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether a place lies in haze, and whether in a solid: where the first face above is seen from
// behind.
#ifndef NIGHTCITY_SHADERS_FAR_PLACES_GLSL
#define NIGHTCITY_SHADERS_FAR_PLACES_GLSL

#include "far_bake.glsl"
#include "convex_face.glsl"
#include "occluders.glsl"

// Not quite upward, so that it meets no edge of walls that stand on a street grid.
const vec3 kUpward = vec3(0.00137, 0.00171, 1.0);

bool isInHaze(vec3 place, FarFieldTable field) {
    Between between = betweenBoxAndBox(place, vec3(0.0), vec3(0.0), vec3(0.0));
    uint walk = 0u;
    for (uint index = nextBoxBetween(bakeTable.mediaNodes, walk, between); index != kNone;
         index = nextBoxBetween(bakeTable.mediaNodes, walk, between)) {
        FarMedium medium = FarMediumArray(field.media).at[index];
        if (all(greaterThan(place, medium.lo)) && all(lessThan(place, medium.hi))) {
            return true;
        }
    }
    return false;
}

bool isInSolid(vec3 place) {
    if (sceneTable.groundMaterial != kNone && place.z < sceneTable.groundHeight) {
        return true;
    }
    if (sceneTable.occluderNodes == uvec2(0) || place.z >= bakeTable.skyHeight) {
        return false;
    }
    vec3 up = (bakeTable.skyHeight - place.z) * kUpward;
    Between between = betweenBoxAndBox(place, vec3(0.0), up, vec3(0.0));
    float nearest = 2.0;
    bool fromBehind = false;
    uint walk = 0u;
    for (uint index = nextOccluder(walk, between); index != kNone;
         index = nextOccluder(walk, between)) {
        OccluderFace face = OccluderFaceArray(sceneTable.occluderFaces).at[index];
        float crossing = faceCrossing(face, place, vec3(0.0), up);
        if (crossing >= 0.0 && crossing < nearest) {
            nearest = crossing;
            fromBehind = dot(face.normal, up) > 0.0;
        }
    }
    return fromBehind;
}

#endif
