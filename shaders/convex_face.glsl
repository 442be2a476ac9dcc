// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether an opaque convex face hides one point or box from another. Places are relative to
// an origin near by, so that float loses nothing far from the scene's.
#ifndef NIGHTCITY_SHADERS_CONVEX_FACE_GLSL
#define NIGHTCITY_SHADERS_CONVEX_FACE_GLSL

#include "addresses.glsl"

vec3 faceCorner(OccluderFace face, uint index, vec3 origin) {
    uint wrapped = index == face.cornerCount ? 0u : index;
    return Vec3Array(sceneTable.occluderCorners).at[face.firstCorner + wrapped] - origin;
}

// Where the straight way from `from` to `to` crosses the face, as a fraction; -1: nowhere.
float faceCrossing(OccluderFace face, vec3 origin, vec3 from, vec3 to) {
    vec3 corner = faceCorner(face, 0u, origin);
    float begin = dot(face.normal, from - corner);
    float end = dot(face.normal, to - corner);
    if (begin * end >= 0.0) {
        return -1.0;
    }
    float fraction = begin / (begin - end);
    vec3 place = from + fraction * (to - from);
    for (uint i = 0u; i < face.cornerCount; ++i) {
        vec3 next = faceCorner(face, i + 1u, origin);
        if (dot(cross(face.normal, next - corner), place - corner) < 0.0) {
            return -1.0;
        }
        corner = next;
    }
    return fraction;
}

#endif
