// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The glow of the paper's model, exact to the tolerance: isotropic points that nothing
// hides, listed by the media boxes. One closed form a light and piece of a segment; a
// segment is cut where its haze is too deep for that.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "counters.glsl"
#include "light_entries.glsl"
#include "transport/airlight.h"
#include "transport/airlight_mean.h"
#include "transport/constants.glsl"

layout(local_size_x = kGroupSize) in;

// From here on quadrature by several nodes is cheaper than more pieces.
const float kMostPieces = 6.0;

struct Piece {
    vec3 start;      // m, from the box's corner
    vec3 direction;  // unit vector
    float span;      // m
    float extinction;
    float depthBefore;
    bool isDeep;     // several nodes a light
};

uint runLength(vec4 run) {
    return floatBitsToUint(run.w) & kRunLengthMask;
}

float overPiece(Piece piece, vec3 fromEmitter) {
    if (piece.isDeep) {
        AirlightInterval i = airlightInterval(fromEmitter, piece.direction, 0.0, piece.span);
        return exp(-piece.depthBefore) *
               airlightIsotropic(i, piece.extinction, frameTable.tolerance);
    }
    return airlightMean(fromEmitter, piece.direction, piece.span, piece.extinction,
                        piece.depthBefore);
}

// The sum over the lights of a list, W/m.
vec3 lightsOver(Piece piece, uint entry, uint endEntry) {
    vec3 sum = vec3(0.0);
    while (entry < endEntry) {
        vec4 run = lightEntry(entry++);
        uint end = entry + runLength(run);
        float perWatt = 0.0;
        for (; entry < end; ++entry) {
            perWatt += overPiece(piece, piece.start - lightEntry(entry).xyz);
        }
        sum += run.rgb * perWatt;
    }
    return sum;
}

vec3 segmentGlow(Segment record, MarchMedium medium, float depthBefore) {
    float span = length(record.span);
    float reach = 0.5 * airlightMeanReach(frameTable.tolerance);
    float pieces = max(ceil(medium.extinction * span / reach), 1.0);
    bool isDeep = pieces > kMostPieces;
    pieces = isDeep ? 1.0 : pieces;
    float share = 1.0 / pieces;
    vec3 sum = vec3(0.0);
    for (float k = 0.0; k < pieces; k += 1.0) {
        Piece piece = Piece(record.start + k * share * record.span,
                            record.span / max(span, 1e-30), share * span, medium.extinction,
                            depthBefore + k * share * span * medium.extinction, isDeep);
        sum += lightsOver(piece, medium.firstEntry, medium.firstEntry + medium.entryCount);
    }
    return kInverse4Pi * kInverse4Pi * medium.scattering * sum;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.pixelCount) {
        return;
    }
    RayProgress progress = RayProgressArray(frameTable.progress).at[index];
    uint lightSegments = 0u;
    for (uint slot = 0; slot < progress.segments; ++slot) {
        Segment record = SegmentArray(frameTable.segments).at[slot * frameTable.bandRays + index];
        MarchMedium medium = MarchMediumArray(sceneTable.marchMedia).at[record.box];
        progress.glow += segmentGlow(record, medium, progress.opticalDepth);
        progress.opticalDepth += medium.extinction * length(record.span);
        lightSegments += medium.lightCount;
    }
    if (progress.segments > 0u) {
        RayProgressArray(frameTable.progress).at[index].glow = progress.glow;
        RayProgressArray(frameTable.progress).at[index].opticalDepth = progress.opticalDepth;
    }
    countLights(lightSegments);
}
