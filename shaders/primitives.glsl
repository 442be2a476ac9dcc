// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What a SurfaceRecord's primitive stands for.
#ifndef NIGHTCITY_SHADERS_PRIMITIVES_GLSL
#define NIGHTCITY_SHADERS_PRIMITIVES_GLSL

#include "addresses.glsl"

bool isPane(uint primitive) {
    return primitive < kGroundPrimitive && (primitive & kPanePrimitive) != 0u;
}

// Index of its material; -1 for sky and panes.
int materialOf(uint primitive) {
    if (primitive == kNone || isPane(primitive)) {
        return -1;
    }
    return int(primitive == kGroundPrimitive
                   ? sceneTable.groundMaterial
                   : TriangleArray(sceneTable.triangles).at[primitive].material);
}

// A point of its plane (m), and a normal of any length. Not for the sky.
void planeOf(uint primitive, out vec3 point, out vec3 normal) {
    if (primitive == kGroundPrimitive) {
        point = vec3(0.0, 0.0, sceneTable.groundHeight);
        normal = vec3(0.0, 0.0, 1.0);
    } else if (isPane(primitive)) {
        Window window = WindowArray(sceneTable.windows).at[primitive & ~kPanePrimitive];
        point = window.centre;
        normal = cross(window.halfU, window.halfV);
    } else {
        uvec3 vertex = TriangleArray(sceneTable.triangles).at[primitive].vertex;
        Vec3Array positions = Vec3Array(sceneTable.positions);
        point = positions.at[vertex.x];
        normal = cross(positions.at[vertex.y] - point, positions.at[vertex.z] - point);
    }
}

#endif
