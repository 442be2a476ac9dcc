// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What one window brings to the nodes of a brick. Places are relative to the brick's centre.
#ifndef NIGHTCITY_SHADERS_FAR_WINDOW_GLSL
#define NIGHTCITY_SHADERS_FAR_WINDOW_GLSL

#extension GL_EXT_control_flow_attributes : require

#include "far_way.glsl"
#include "transport/pane_solid_angle.h"

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
    float extinction;   // and this
    uint ways[3u * kWayWords];  // and these
    uint corners;       // of a cluster: what the corners of the brick see
};

FarWindow clusterWindow(FarLight light, vec3 origin) {
    FarWindow found;
    found.centre = light.centre - origin;
    found.a = 0.0;
    found.b = 0.0;
    // Isotropic windows have no axis: any will do.
    found.normal = kFarEmitter == kEmitterIsotropic ? vec3(0.0, 0.0, 1.0) : light.axis;
    vec3 other = abs(found.normal.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
    found.u = normalize(cross(other, found.normal));
    found.v = cross(found.normal, found.u);
    found.exactBelow = 0.0;
    found.isSphere = false;
    return found;
}

FarWindow farWindow(uint index, vec3 origin) {
    FarEntryArray entries = FarEntryArray(bakeTable.entries);
    FarLight light = FarLightArray(bakeTable.lights).at[entries.at[index].light];
    FarWindow found = clusterWindow(light, origin);
    found.faceCount = entries.at[index].faceCount;
    found.extinction = entries.at[index].extinction;
    found.corners = entries.at[index].face[0];
    if (found.extinction < 0.0) {
        [[unroll]] for (uint i = 0u; i < 3u * kWayWords; ++i) {
            found.ways[i] = entries.at[index].ways[i];
        }
    }
    if (light.second != 0u) {
        return found;
    }
    Window window = WindowArray(sceneTable.windows).at[light.window];
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

// What of a window's light the nodes of a brick hold.
struct BakedShare {
    float perSquare;  // 1 / R^2 of near_far_split.h, m^-2
    bool isBlurred;
};

BakedShare bakedShare(FarFieldTable field, FarBrick brick) {
    float radius = splitRadius(field, brick);
    return BakedShare(1.0 / (radius * radius), isBlurred(field, brick.scale));
}

// squared: of the distance from the window's centre, m^2.
float shareAt(BakedShare baked, float squared) {
    return bakedShare(squared * baked.perSquare, baked.isBlurred);
}

// `extinction`: 1/m, the mean on the way.
float bakedFluencePerWatt(FarWindow window, vec3 place, float extinction, BakedShare baked) {
    vec3 way = place - window.centre;
    float squared = dot(way, way);
    float share = shareAt(baked, squared);
    if (share == 0.0) {
        return 0.0;
    }
    float clear = clearFluence(window, way, squared);
    if (clear == 0.0) {
        return 0.0;
    }
    return share * clear * exp(-extinction * sqrt(squared));
}

#endif
