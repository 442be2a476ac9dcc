// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds one sample a pixel to the images of a band, in the order of the samples.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "primitives.glsl"

layout(local_size_x = kGroupSize) in;
layout(constant_id = NIGHTCITY_CONSTANT_MEDIA) const uint kMedia = 1;

void keepCentre(uint index, SurfaceRecord record, int firstMediaId) {
    FloatArray(frameTable.depth).at[index] = record.depth;
    Vec3Array(frameTable.normal).at[index] = record.normal;
    FloatArray(frameTable.mediaId).at[index] = float(firstMediaId);
    FloatArray(frameTable.materialId).at[index] = float(materialOf(record.primitive));
}

// Of the mean of all paths, taken as independent draws of equal weight: where a pixel has
// several samples, their spread in the pixel counts as noise.
void keepError(uint index, vec3 mean) {
    float paths = float(frameTable.sampleCount) * float(frameTable.paths);
    vec3 meanSquare = Vec3Array(frameTable.glowSquares).at[index] / paths;
    vec3 variance = max(meanSquare - mean * mean, vec3(0.0));
    Vec3Array(frameTable.glowError).at[index] = sqrt(variance / max(paths - 1.0, 1.0));
}

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
    float weight = 1.0 / float(frameTable.sampleCount);
    float alpha = record.primitive == kNone ? 1.0 - transmittance : 1.0;
    vec3 surface = record.radiance * transmittance;
    vec4 sumSurface = vec4(surface, alpha) * weight;
    vec3 sumGlow = glow * weight;
    float sumTransmittance = transmittance * weight;
    if (push.sampleIndex > 0u) {
        sumSurface.rgb += Vec3Array(frameTable.surface).at[index];
        sumSurface.a += Vec4Array(frameTable.beauty).at[index].a;
        sumGlow += Vec3Array(frameTable.glow).at[index];
        sumTransmittance += FloatArray(frameTable.transmittance).at[index];
    }
    Vec3Array(frameTable.surface).at[index] = sumSurface.rgb;
    Vec3Array(frameTable.glow).at[index] = sumGlow;
    Vec4Array(frameTable.beauty).at[index] = vec4(sumSurface.rgb + sumGlow, sumSurface.a);
    FloatArray(frameTable.transmittance).at[index] = sumTransmittance;
    if (frameTable.paths > 0u && push.sampleIndex + 1u == frameTable.sampleCount) {
        keepError(index, sumGlow);
    }
    if (push.sampleIndex == frameTable.centreSample) {
        keepCentre(index, record, firstMediaId);
    }
}
