// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What a camera ray sees of a window: where it meets the pane, and what the
// pane sends.
#ifndef NIGHTCITY_SHADERS_PANE_GLSL
#define NIGHTCITY_SHADERS_PANE_GLSL

#include "camera_ray.glsl"
#include "transport/emitters.glsl"

vec3 paneNormal(Window window) {
    return normalize(cross(window.halfU, window.halfV));
}

// Unit vector, to the bright side; 0 for a sphere, which has none.
vec3 outward(Window window) {
    bool isSphere = (window.flags & kWindowSphere) != 0u;
    return isSphere ? vec3(0.0) : paneNormal(window);
}

// Depth where the ray crosses the pane, from either side; negative for a miss. Spheres light
// the haze but are not seen. halfU and halfV are perpendicular.
float paneDepth(Ray ray, Window window) {
    if ((window.flags & kWindowSphere) != 0u) {
        return -1.0;
    }
    vec3 normal = cross(window.halfU, window.halfV);
    float depth = dot(window.centre - ray.origin, normal) / dot(ray.direction, normal);
    vec3 fromCentre = (ray.origin - window.centre) + depth * ray.direction;
    bool inside = abs(dot(fromCentre, window.halfU)) <= dot(window.halfU, window.halfU) &&
                  abs(dot(fromCentre, window.halfV)) <= dot(window.halfV, window.halfV);
    return inside ? depth : -1.0;
}

bool hiddenBy(float wall, Ray ray, Window window, float depth) {
    float facing = dot(ray.direction, paneNormal(window));
    float reach = facing < 0.0 ? kPaneOnWall : 0.0;
    return (depth - wall) * abs(facing) > reach;
}

bool isLit(uint window) {
    return (UintArray(sceneTable.windowOn).at[window >> 5] >> (window & 31u) & 1u) != 0u;
}

// Radiance towards a camera that looks along `direction`: none from behind, none unlit.
vec3 paneRadiance(uint index, Window window, vec3 direction) {
    if (!isLit(index) || dot(direction, paneNormal(window)) >= 0.0) {
        return vec3(0.0);
    }
    float area = paneArea(window.halfU, window.halfV);
    return lambertianRadiance(window.power, area) * window.colour;
}

#endif
