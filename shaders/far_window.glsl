// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What one window brings to the nodes of a brick. Places are relative to the brick's centre.
#ifndef NIGHTCITY_SHADERS_FAR_WINDOW_GLSL
#define NIGHTCITY_SHADERS_FAR_WINDOW_GLSL

#include "convex_face.glsl"
#include "far_bake.glsl"
#include "occluders.glsl"
#include "transport/near_far_split.h"
#include "transport/pane_solid_angle.h"

NIGHTCITY_ARRAY(MediaArray, FarMedium)

const float kTurn = 6.28318530717958648;
const float kExactSides = 3.0;  // nearer than so many longer sides the solid angle is exact

// Where on a pane sight is tested, in its half sides: no two points in one row or column,
// so that the edge of a shadow, mostly upright or level, passes them one by one.
const vec2 kPanePoint[4] = vec2[](vec2(-0.75, 0.25), vec2(-0.25, -0.75), vec2(0.25, 0.75),
                                  vec2(0.75, -0.25));

struct FarWindow {
    vec3 centre;
    vec3 u, v, normal;  // unit vectors
    float a, b;         // half sides, m
    float exactBelow;   // m^2
    bool isSphere;
    uint faceCount;     // as FarEntry has it
    float extinction;   // 1/m, on all ways to the brick; negative: ask the media
};

FarWindow farWindow(uint index, vec3 origin, FarFieldTable field) {
    FarEntryArray entries = FarEntryArray(bakeTable.entries);
    uint light = entries.at[index].light;
    Window window =
        WindowArray(sceneTable.windows).at[FarLightArray(bakeTable.lights).at[light].window];
    FarWindow found;
    uint medium = entries.at[index].medium;
    found.extinction = medium == kNone ? -1.0 : MediaArray(field.media).at[medium].extinction;
    found.faceCount = entries.at[index].faceCount;
    found.centre = window.centre - origin;
    found.a = length(window.halfU);
    found.b = length(window.halfV);
    found.u = window.halfU / found.a;
    found.v = window.halfV / found.b;
    found.normal = cross(found.u, found.v);
    float exact = 2.0 * kExactSides * max(found.a, found.b);
    found.exactBelow = exact * exact;
    found.isSphere = (window.flags & kWindowSphere) != 0u;
    return found;
}

bool isPane(FarWindow window) {
    return kFarEmitter == kEmitterPane && !window.isSphere;
}

vec3 panePoint(FarWindow window, uint index) {
    vec2 at = isPane(window) ? kPanePoint[index] : vec2(0.0);
    return window.centre + at.x * window.a * window.u + at.y * window.b * window.v;
}

bool isHiddenByAny(vec3 from, vec3 to, vec3 origin) {
    Between between = betweenBoxAndStretch(origin + from, vec3(0.0), to - from, to - from);
    uint walk = 0u;
    for (uint index = nextOccluder(walk, between); index != kNone;
         index = nextOccluder(walk, between)) {
        OccluderFace face = OccluderFaceArray(sceneTable.occluderFaces).at[index];
        if (faceCrossing(face, origin, from, to) >= 0.0) {
            return true;
        }
    }
    return false;
}

// Of the straight way, through all media on it.
float depthThroughMedia(vec3 from, vec3 to, vec3 origin, FarFieldTable field) {
    vec3 way = to - from;
    vec3 start = origin + from;
    Between between = betweenBoxAndStretch(start, vec3(0.0), way, way);
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

// m^-2: fluence per watt in clear air, all of the window seen.
float clearFluence(FarWindow window, vec3 way, float squared) {
    if (kFarEmitter == kEmitterIsotropic || window.isSphere) {
        bool inside = window.isSphere && squared < window.a * window.a;
        return inside ? 0.0 : 1.0 / (2.0 * kTurn * squared);
    }
    float height = dot(way, window.normal);
    if (height <= 0.0) {
        return 0.0;
    }
    if (kFarEmitter == kEmitterLambertian) {
        return height / (0.5 * kTurn * squared * sqrt(squared));
    }
    vec3 point = vec3(dot(way, window.u), dot(way, window.v), max(height, kPaneNearest));
    return paneSolidAngle(point, window.a, window.b) / (2.0 * kTurn * window.a * window.b);
}

float farFluencePerWatt(FarWindow window, vec3 origin, vec3 place, FarFieldTable field) {
    vec3 way = place - window.centre;
    float squared = dot(way, way);
    float share = farShare(squared / (field.nearRadius * field.nearRadius));
    if (share == 0.0) {
        return 0.0;
    }
    float clear = clearFluence(window, way, squared);
    if (clear == 0.0) {
        return 0.0;
    }
    float depth = window.extinction >= 0.0
                      ? window.extinction * sqrt(squared)
                      : depthThroughMedia(window.centre, place, origin, field);
    return share * clear * exp(-depth);
}

#endif
