// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds samples to the images of a band, in the order of the samples. A store costs
// about as much as a load or the arithmetic of a wall, so only the images wanted are written.
#ifndef NIGHTCITY_SHADERS_IMAGE_SUMS_GLSL
#define NIGHTCITY_SHADERS_IMAGE_SUMS_GLSL

#include "aovs.h"
#include "primitives.glsl"

// With several samples a pixel, surface and glow are sums that beauty is made of.
layout(constant_id = NIGHTCITY_CONSTANT_AOVS) const uint kAovs = kAllAovs;

bool isKept(uint aov) {
    return (kAovs & aov) != 0u;
}

// Of the sample nearest the pixel's centre.
void keepCentre(uint index, SurfaceRecord record, int firstMediaId) {
    if (isKept(kAovDepth)) {
        FloatArray(frameTable.depth).at[index] = record.depth;
    }
    if (isKept(kAovNormal)) {
        Vec3Array(frameTable.normal).at[index] = record.normal;
    }
    if (isKept(kAovMediaId)) {
        FloatArray(frameTable.mediaId).at[index] = float(firstMediaId);
    }
    if (isKept(kAovMaterialId)) {
        FloatArray(frameTable.materialId).at[index] = float(materialOf(record.primitive));
    }
}

// Of the mean of all paths, taken as independent draws of equal weight: where a pixel has
// several samples, their spread in the pixel counts as noise.
void keepError(uint index, vec3 mean) {
    float paths = float(frameTable.sampleCount) * float(frameTable.paths);
    vec3 meanSquare = Vec3Array(frameTable.glowSquares).at[index] / paths;
    vec3 variance = max(meanSquare - mean * mean, vec3(0.0));
    Vec3Array(frameTable.glowError).at[index] = sqrt(variance / max(paths - 1.0, 1.0));
}

void storeSums(uint index, vec4 surface, vec3 glow, float transmittance) {
    if (isKept(kAovSurface)) {
        Vec3Array(frameTable.surface).at[index] = surface.rgb;
    }
    if (isKept(kAovGlow)) {
        Vec3Array(frameTable.glow).at[index] = glow;
    }
    if (isKept(kAovBeauty)) {
        Vec4Array(frameTable.beauty).at[index] = vec4(surface.rgb + glow, surface.a);
    }
    if (isKept(kAovTransmittance)) {
        FloatArray(frameTable.transmittance).at[index] = transmittance;
    }
}

// Of the same sample, after addSample. `error`: as GlowLedger has it.
void addLedger(uint index, vec3 glow, float error, float cost) {
    if (isKept(kAovError)) {
        float sum = error / float(frameTable.sampleCount);
        if (push.sampleIndex > 0u) {
            sum += FloatArray(frameTable.error).at[index];
        }
        if (push.sampleIndex + 1u == frameTable.sampleCount) {
            vec3 mean = push.sampleIndex > 0u ? Vec3Array(frameTable.glow).at[index] : glow;
            float brightest = max(mean.r, max(mean.g, mean.b));
            sum = brightest > 0.0 ? sum / brightest : 0.0;
        }
        FloatArray(frameTable.error).at[index] = sum;
    }
    if (isKept(kAovCost)) {
        if (push.sampleIndex > 0u) {
            cost += FloatArray(frameTable.cost).at[index];
        }
        FloatArray(frameTable.cost).at[index] = cost;
    }
}

// Sample push.sampleIndex of the pixel at `index` in the band. `firstMediaId`: -1 for none.
void addSample(uint index, SurfaceRecord record, vec3 glow, float transmittance,
               int firstMediaId) {
    float weight = 1.0 / float(frameTable.sampleCount);
    float alpha = record.primitive == kNone ? 1.0 - transmittance : 1.0;
    vec4 sumSurface = vec4(record.radiance * transmittance, alpha) * weight;
    vec3 sumGlow = glow * weight;
    float sumTransmittance = transmittance * weight;
    if (push.sampleIndex > 0u) {
        if (isKept(kAovSurface)) {
            sumSurface.rgb += Vec3Array(frameTable.surface).at[index];
        }
        if (isKept(kAovBeauty)) {
            sumSurface.a += Vec4Array(frameTable.beauty).at[index].a;
        }
        if (isKept(kAovGlow)) {
            sumGlow += Vec3Array(frameTable.glow).at[index];
        }
        if (isKept(kAovTransmittance)) {
            sumTransmittance += FloatArray(frameTable.transmittance).at[index];
        }
    }
    storeSums(index, sumSurface, sumGlow, sumTransmittance);
    if (frameTable.paths > 0u && push.sampleIndex + 1u == frameTable.sampleCount) {
        keepError(index, sumGlow);
    }
    if (push.sampleIndex == frameTable.centreSample) {
        keepCentre(index, record, firstMediaId);
    }
}

#endif
