// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds one sample a pixel to the images of a band, in the order of the samples.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "image_sums.glsl"

layout(local_size_x = kGroupSize) in;
layout(constant_id = NIGHTCITY_CONSTANT_MEDIA) const uint kMedia = 1;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.pixelCount) {
        return;
    }
    SurfaceRecord record = SurfaceRecordArray(frameTable.surfaces).at[index];
    vec3 glow = vec3(0.0);
    float transmittance = 1.0;
    int firstMediaId = -1;
    if (kMedia != 0u) {
        RayProgress progress = RayProgressArray(frameTable.progress).at[index];
        glow = progress.glow;
        transmittance = exp(-progress.opticalDepth);
        firstMediaId = progress.firstMediaId;
    }
    addSample(index, record, glow, transmittance, firstMediaId);
}
