// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The paper's march: N equal steps a segment, at their midpoints the in-scatter
// of the lights listed by the segment's box.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "counters.glsl"
#include "light_entries.glsl"
#include "transport/in_scatter.glsl"

layout(local_size_x = kGroupSize) in;
layout(constant_id = NIGHTCITY_CONSTANT_LIGHTS_OUTSIDE) const uint kLightsOutside = 1;
layout(constant_id = NIGHTCITY_CONSTANT_SUBDIVISIONS) const uint kSteps = 25;

// One segment in the coordinates of the march.
struct MarchSegment {
    vec3 start;          // m, from the box's corner
    vec3 stride;         // m, one step
    float extinction;    // 1/m
    float stepDepth;     // optical depth of one step
    float opticalDepth;  // before the segment
    uint firstEntry;     // of the light list
    uint endEntry;
};

float atStep(MarchSegment segment, vec3 startToLight, float midpoint) {
    vec3 toLight = fma(vec3(-midpoint), segment.stride, startToLight);
    return attenuatedInverseSquare(toLight, segment.extinction,
                                   fma(midpoint, segment.stepDepth, segment.opticalDepth));
}

uint runLength(vec4 run) {
    return floatBitsToUint(run.w) & kRunLengthMask;
}

// The sum over the steps for one light.
float overSteps(MarchSegment segment, vec3 startToLight) {
    float sum = 0.0;
    uint step = 0;
    for (; step + 5 <= kSteps; step += 5) {  // unrolled: a loop costs as much as a step
        float midpoint = float(step) + 0.5;
        sum += atStep(segment, startToLight, midpoint) +
               atStep(segment, startToLight, midpoint + 1.0) +
               atStep(segment, startToLight, midpoint + 2.0) +
               atStep(segment, startToLight, midpoint + 3.0) +
               atStep(segment, startToLight, midpoint + 4.0);
    }
    for (; step < kSteps; ++step) {
        sum += atStep(segment, startToLight, float(step) + 0.5);
    }
    return sum;
}

// For every light, all steps.
vec3 marchLightsOutside(MarchSegment segment) {
    vec3 sum = vec3(0.0);
    for (uint entry = segment.firstEntry; entry < segment.endEntry;) {
        vec4 run = lightEntry(entry++);
        uint end = entry + runLength(run);
        float fluence = 0.0;
        for (; entry < end; ++entry) {
            fluence += overSteps(segment, lightEntry(entry).xyz - segment.start);
        }
        sum += run.rgb * fluence;
    }
    return sum;
}

// For every step, all lights: the loop as the paper describes it.
vec3 marchStepsOutside(MarchSegment segment) {
    vec3 sum = vec3(0.0);
    for (uint step = 0; step < kSteps; ++step) {
        float midpoint = float(step) + 0.5;
        vec3 position = fma(vec3(midpoint), segment.stride, segment.start);
        float opticalDepth = fma(midpoint, segment.stepDepth, segment.opticalDepth);
        for (uint entry = segment.firstEntry; entry < segment.endEntry;) {
            vec4 run = lightEntry(entry++);
            uint end = entry + runLength(run);
            float fluence = 0.0;
            for (; entry < end; ++entry) {
                fluence += attenuatedInverseSquare(lightEntry(entry).xyz - position,
                                                   segment.extinction, opticalDepth);
            }
            sum += run.rgb * fluence;
        }
    }
    return sum;
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
        float stepLength = length(record.span) / float(kSteps);
        MarchSegment segment =
            MarchSegment(record.start, record.span / float(kSteps), medium.extinction,
                         medium.extinction * stepLength, progress.opticalDepth,
                         medium.firstEntry, medium.firstEntry + medium.entryCount);
        vec3 sum = kLightsOutside != 0u ? marchLightsOutside(segment)
                                        : marchStepsOutside(segment);
        progress.glow += inScatterScale(medium.scattering, stepLength) * sum;
        progress.opticalDepth += medium.extinction * length(record.span);
        lightSegments += medium.lightCount;
    }
    if (progress.segments > 0u) {
        RayProgressArray(frameTable.progress).at[index].glow = progress.glow;
        RayProgressArray(frameTable.progress).at[index].opticalDepth = progress.opticalDepth;
    }
    countLights(lightSegments);
}
