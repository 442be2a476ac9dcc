// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The nearest opaque surface of every ray of a band, and the light that it
// sends to the camera.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "intersect.glsl"
#include "primitives.glsl"
#include "surface_shading.glsl"

layout(local_size_x = kGroupSize) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.pixelCount) {
        return;
    }
    Ray ray = cameraRay(pixelOf(push.firstPixel + index), push.sampleIndex);
    float ground = groundDepth(ray);
    TriangleHit hit = nearestTriangle(ray, ground);
    SurfaceRecord record = SurfaceRecord(vec3(0.0), kFar, vec3(0.0), kNone);
    if (hit.triangle != kNone) {
        record = shadeTriangle(ray, hit);
    } else if (ground < kFar) {
        record = shadeGround(ray, ground);
    }
    PaneHit loose = nearestLoosePane(ray, hit.depth);
    if (loose.window != kNone && (!isPane(record.primitive) || loose.depth < record.depth)) {
        record = shadePane(ray, loose);
    }
    SurfaceRecordArray(frameTable.surfaces).at[index] = record;
}
