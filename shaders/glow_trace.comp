// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The glow along the rays that a round chose: push.round. One thread a ray.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "glow_along_ray.glsl"
#include "glow_cells.glsl"

layout(local_size_x = kGroupSize) in;

void main() {
    GlowTable table = glowTable;
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= GlowRoundArray(table.rounds).at[push.round].count) {
        return;
    }
    uint index = UintArray(table.lists).at[push.round * table.capacity + slot];
    Ray ray = cameraRay(pixelOf(push.firstPixel + index), push.sampleIndex);
    float scale = length(ray.direction);
    float depth = SurfaceRecordArray(frameTable.surfaces).at[index].depth;
    GlowSampleArray(table.samples).at[index] =
        glowAlongRay(Ray(ray.origin, ray.direction / scale), depth * scale, table.tolerance);
}
