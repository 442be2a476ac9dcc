// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The first media box on every ray of a band, for methods that do not ask box by box.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "intersect.glsl"

layout(local_size_x = kGroupSize) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.pixelCount) {
        return;
    }
    Ray ray = cameraRay(pixelOf(push.firstPixel + index), push.sampleIndex);
    RayProgressArray(frameTable.progress).at[index].firstMediaId =
        firstMediaId(ray, SurfaceRecordArray(frameTable.surfaces).at[index].depth);
}
