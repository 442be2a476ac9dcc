// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The paper's march: N equal steps a segment, at their midpoints the in-scatter
// of the lights listed by the segment's box.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "light_entries.glsl"
#include "transport/in_scatter.glsl"

layout(local_size_x = kGroupSize) in;
layout(constant_id = NIGHTCITY_CONSTANT_LIGHTS_OUTSIDE) const uint kLightsOutside = 1;
layout(constant_id = NIGHTCITY_CONSTANT_ONE_COLOUR) const uint kOneColour = 0;

// One segment in the coordinates of the march.
struct MarchSegment {
    vec3 start;          // m, from the box's corner
    vec3 stride;         // m, one step
    float extinction;    // 1/m
    float stepDepth;     // optical depth of one step
    float opticalDepth;  // before the segment
    uint firstLight;
    uint lightCount;
};

const uint kEntrySize = kOneColour != 0u ? 1u : 2u;  // vec4 a light

vec3 entryPower(uint entry, vec4 light) {
    return kOneColour != 0u ? light.w * sceneTable.colour : lightEntry(entry + 1u).rgb;
}

float atStep(MarchSegment segment, vec3 startToLight, float step) {
    return attenuatedInverseSquare(startToLight - step * segment.stride, segment.extinction,
                                   segment.opticalDepth + step * segment.stepDepth);
}

// For every light, the sum over the steps: its colour is applied once.
vec3 marchLightsOutside(MarchSegment segment, uint steps) {
    vec3 sum = vec3(0.0);
    for (uint i = 0; i < segment.lightCount; ++i) {
        uint entry = (segment.firstLight + i) * kEntrySize;
        vec4 light = lightEntry(entry);
        vec3 startToLight = light.xyz - segment.start;
        float fluence = 0.0;
        for (uint step = 0; step < steps; ++step) {
            fluence += atStep(segment, startToLight, float(step) + 0.5);
        }
        sum += fluence * entryPower(entry, light);
    }
    return sum;
}

// For every step, every light: the loop as the paper describes it.
vec3 marchStepsOutside(MarchSegment segment, uint steps) {
    vec3 sum = vec3(0.0);
    for (uint step = 0; step < steps; ++step) {
        float midpoint = float(step) + 0.5;
        for (uint i = 0; i < segment.lightCount; ++i) {
            uint entry = (segment.firstLight + i) * kEntrySize;
            vec4 light = lightEntry(entry);
            sum += atStep(segment, light.xyz - segment.start, midpoint) * entryPower(entry, light);
        }
    }
    return sum;
}

void countLights(uint lightSegments) {
    if (lightSegments == 0u) {
        return;
    }
    CountersReference counters = CountersReference(frameTable.counters);
    uint before = atomicAdd(counters.counters.lightSegmentsLow, lightSegments);
    if (before + lightSegments < before) {
        atomicAdd(counters.counters.lightSegmentsHigh, 1u);
    }
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.pixelCount) {
        return;
    }
    RayProgress progress = RayProgressArray(frameTable.progress).at[index];
    uint steps = frameTable.subdivisions;
    uint lightSegments = 0u;
    for (uint slot = 0; slot < progress.segments; ++slot) {
        Segment record = SegmentArray(frameTable.segments).at[slot * frameTable.bandRays + index];
        MarchMedium medium = MarchMediumArray(sceneTable.marchMedia).at[record.box];
        float stepLength = length(record.span) / float(steps);
        MarchSegment segment =
            MarchSegment(record.start, record.span / float(steps), medium.extinction,
                         medium.extinction * stepLength, progress.opticalDepth,
                         medium.firstLight, medium.lightCount);
        vec3 sum = kLightsOutside != 0u ? marchLightsOutside(segment, steps)
                                        : marchStepsOutside(segment, steps);
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
