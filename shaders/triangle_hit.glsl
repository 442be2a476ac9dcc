// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a ray meets one triangle, by the pixel's own ray: whoever found the
// triangle, rasterisation or a ray query, what follows is the same to the bit.
#ifndef NIGHTCITY_SHADERS_TRIANGLE_HIT_GLSL
#define NIGHTCITY_SHADERS_TRIANGLE_HIT_GLSL

#include "box_interval.glsl"
#include "camera_ray.glsl"

struct TriangleHit {
    float depth;        // of the plane; for no triangle the end asked for
    uint triangle;      // or kNone
    vec2 barycentrics;  // of the second and third corner
    vec3 normal;        // of any length, outward
};

// Where the ray meets a plane, a point of which lies at `towards` from the ray's origin. Across an
// axis the expression is that of boxInterval, so that haze which ends at a wall ends there to the
// bit, also seen along it.
float crossing(Ray ray, vec3 normal, vec3 towards, float inverse) {
    vec3 each = towards * reciprocal(ray.direction);
    bvec3 zero = equal(normal, vec3(0.0));
    if (zero.y && zero.z) {
        return each.x;
    }
    if (zero.z && zero.x) {
        return each.y;
    }
    return zero.x && zero.y ? each.z : dot(normal, towards) * inverse;
}

// The triangle's plane, hit or not: inside() tells. Moeller and Trumbore, Fast, minimum storage
// ray-triangle intersection, JGT 2 (1997).
TriangleHit planeHit(Ray ray, uint index) {
    uvec3 vertex = TriangleArray(sceneTable.triangles).at[index].vertex;
    Vec3Array positions = Vec3Array(sceneTable.positions);
    vec3 corner = positions.at[vertex.x];
    vec3 second = positions.at[vertex.y] - corner;
    vec3 third = positions.at[vertex.z] - corner;
    vec3 towards = corner - ray.origin;
    vec3 normal = cross(second, third);
    vec3 across = cross(towards, ray.direction);
    float inverse = 1.0 / dot(normal, ray.direction);
    float u = dot(across, third) * inverse;
    float v = -dot(across, second) * inverse;
    float depth = crossing(ray, normal, towards, inverse);
    return TriangleHit(depth, index, vec2(u, v), normal);
}

// False for what is no number.
bool inside(TriangleHit hit) {
    return hit.depth > 0.0 && hit.barycentrics.x >= 0.0 && hit.barycentrics.y >= 0.0 &&
           hit.barycentrics.x + hit.barycentrics.y <= 1.0;
}

#endif
