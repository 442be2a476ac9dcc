// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The nearest opaque surface of every ray of a band, and the light that it
// sends to the camera.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "surface_shading.glsl"

layout(local_size_x = kGroupSize) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.pixelCount) {
        return;
    }
    uvec2 pixel = pixelOf(push.firstPixel + index);
    Ray ray = cameraRay(pixel, push.sampleIndex);
    SurfaceRecordArray(frameTable.surfaces).at[index] = seenSurface(pixel, ray);
}
