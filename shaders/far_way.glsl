// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Straight ways between two points: whether anything opaque is on them, and how much haze.
// Places are relative to `origin`, a point near by.
#ifndef NIGHTCITY_SHADERS_FAR_WAY_GLSL
#define NIGHTCITY_SHADERS_FAR_WAY_GLSL

#include "convex_face.glsl"
#include "far_bake.glsl"
#include "occluders.glsl"

NIGHTCITY_ARRAY(MediaArray, FarMedium)

// Long ways are looked at near their ends first: a city mostly hides things there, and the boxes
// of what is farther along are then never asked about.
const float kNearEnd = 24.0;  // m

// Whether a face that a part of the way meets hides one end of it from the other.
bool isHiddenWithin(vec3 begin, vec3 end, vec3 from, vec3 to, vec3 origin) {
    Between between = betweenBoxAndBox(origin + begin, vec3(0.0), end - begin, vec3(0.0));
    uint walk = 0u;
    for (uint index = nextOccluder(walk, between); index != kNone;
         index = nextOccluder(walk, between)) {
        OccluderFace face = OccluderFaceArray(sceneTable.occluderFaces).at[index];
        float beyond = dot(face.normal, to - faceCorner(face, 0u, origin));
        if (abs(beyond) > kOnFace && faceCrossing(face, origin, from, to) >= 0.0) {
            return true;
        }
    }
    return false;
}

// Not by a face on which `to` lies.
bool isHiddenByAny(vec3 from, vec3 to, vec3 origin) {
    vec3 way = to - from;
    float length2 = dot(way, way);
    if (length2 <= 9.0 * kNearEnd * kNearEnd) {
        return isHiddenWithin(from, to, from, to, origin);
    }
    vec3 atEnds = kNearEnd * inversesqrt(length2) * way;
    return isHiddenWithin(to - atEnds, to, from, to, origin) ||
           isHiddenWithin(from, from + atEnds, from, to, origin) ||
           isHiddenWithin(from + atEnds, to - atEnds, from, to, origin);
}

// Of the straight way, through all media on it.
float depthThroughMedia(vec3 from, vec3 to, vec3 origin, FarFieldTable field) {
    vec3 way = to - from;
    vec3 start = origin + from;
    Between between = betweenBoxAndBox(start, vec3(0.0), way, vec3(0.0));
    vec3 pace = paceOf(way);
    float depth = 0.0;
    uint walk = 0u;
    for (uint index = nextBoxBetween(bakeTable.mediaNodes, walk, between); index != kNone;
         index = nextBoxBetween(bakeTable.mediaNodes, walk, between)) {
        FarMedium medium = MediaArray(field.media).at[index];
        vec3 toLo = (medium.lo - start) * pace;
        vec3 toHi = (medium.hi - start) * pace;
        vec3 first = min(toLo, toHi);
        vec3 last = max(toLo, toHi);
        float begin = max(max(first.x, first.y), max(first.z, 0.0));
        float end = min(min(last.x, last.y), min(last.z, 1.0));
        depth += medium.extinction * max(end - begin, 0.0);
    }
    return depth * length(way);
}

#endif
