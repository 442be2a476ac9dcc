// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a ray through the haze ends, and what the surface there reflects of the light that
// comes straight from the windows.
#ifndef NIGHTCITY_SHADERS_PATH_ENDS_GLSL
#define NIGHTCITY_SHADERS_PATH_ENDS_GLSL

#include "in_scattered_light.glsl"
#include "surface_shading.glsl"

layout(constant_id = NIGHTCITY_CONSTANT_LIT) const uint kLit = 0;

// m, off a surface: where the next ray begins, so that it does not meet the same surface.
const float kOffSurface = 1e-4;
// Where a ray ends: distance (m), and what the surface there reflects.
struct RayEnd {
    float distance;
    vec3 normal;
    vec3 reflectance;
};

vec3 reflectanceOf(SurfaceRecord record) {
    return record.primitive == kNone || isPane(record.primitive) ? vec3(0.0)
                                                                 : record.radiance / kDim;
}

RayEnd endOf(Ray ray) {
    if (kLit != 0u) {
        SurfaceRecord record = nearestSurface(ray);
        return RayEnd(record.depth, record.normal, reflectanceOf(record));
    }
    TriangleHit hit = nearestTriangle(ray, groundDepth(ray));
    return RayEnd(hit.depth, vec3(0.0), vec3(0.0));
}

// Radiance that a surface reflects of the light straight from a window.
vec3 reflectedLight(Ray ray, RayEnd end, inout RandomStream random) {
    vec3 point = ray.origin + end.distance * ray.direction;
    float extinction = 0.0;
    if (kMedia != 0u) {
        HazePoint haze = hazeAtDistance(ray, end.distance);
        extinction = haze.extinction;
    }
    LightChoice light = chooseLight(lightsAt(point, extinction), random);
    vec3 before = point - kOffSurface * ray.direction;
    if (light.window == kNone || (kListed != 0u && !isListedAt(before, light.window))) {
        return vec3(0.0);
    }
    vec3 off = point + kOffSurface * end.normal;
    vec3 fromCentre = off - WindowArray(sceneTable.windows).at[light.window].centre;
    DirectLight direct = directLight(light.window, off, fromCentre, extinction, random);
    float received = max(dot(direct.direction, end.normal), 0.0);
    return end.reflectance / kPi * received / light.probability * direct.fluence;
}

#endif
