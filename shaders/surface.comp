// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The nearest opaque surface of every ray of a band, and the light that it
// sends to the camera: as records for the passes that follow (without normals where none of
// them asks), or, where there is no haze, straight into the images.
#version 460
#extension GL_GOOGLE_include_directive : require

// glslang 12 hangs while it spreads `precise` through this program. Nothing here needs it: a
// difference times a factor, as groundDepth has it, cannot be contracted.
#define precise

#include "image_sums.glsl"
#include "surface_shading.glsl"

layout(local_size_x = kGroupSize) in;
layout(constant_id = NIGHTCITY_CONSTANT_TASK) const uint kTask = kTaskRecords;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.pixelCount) {
        return;
    }
    if (kTask == kTaskWrite) {
        float value = float(push.firstPixel + index);  // or the compiler would write a constant
        addSample(index, SurfaceRecord(vec3(value), value, vec3(value), kNone), vec3(0.0), 1.0, -1);
        return;
    }
    uvec2 pixel = pixelOf(push.firstPixel + index);
    SurfaceRecord record = seenSurface(pixel, cameraRay(pixel, push.sampleIndex));
    if (kTask == kTaskImages) {
        addSample(index, record, vec3(0.0), 1.0, -1);
    } else if (isKept(kAovNormal)) {
        SurfaceRecordArray(frameTable.surfaces).at[index] = record;
    } else {
        SurfaceRecordArray(frameTable.surfaces).at[index].radiance = record.radiance;
        SurfaceRecordArray(frameTable.surfaces).at[index].depth = record.depth;
        SurfaceRecordArray(frameTable.surfaces).at[index].primitive = record.primitive;
    }
}
