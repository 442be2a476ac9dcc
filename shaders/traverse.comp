// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the media boxes on every ray of a band, up to its surface, and hands
// the segments to the march: the next kSegmentSlots of them a round.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "intersect.glsl"
#include "segment_ends.glsl"

layout(local_size_x = kGroupSize) in;

RayProgress progressBefore(uint index) {
    if (push.round == 0u) {
        return RayProgress(-1.0, kNone, 0u, -1, vec3(0.0), 0.0);
    }
    return RayProgressArray(frameTable.progress).at[index];
}

void writeSegments(uint index, uint count, MediaHits hits, SurfaceRecord surface) {
    PreciseRay ray = preciseCameraRay(pixelOf(push.firstPixel + index), push.sampleIndex);
    for (uint slot = 0; slot < kSegmentSlots; ++slot) {
        if (slot < count) {
            MediaBox box = MediaBoxArray(sceneTable.mediaBoxes).at[hits.box[slot]];
            SegmentArray(frameTable.segments).at[slot * frameTable.bandRays + index] =
                segmentBetween(ray, box.lo, box.hi, hits.box[slot], hits.entry[slot],
                               hits.exit[slot], surface);
        }
    }
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.pixelCount) {
        return;
    }
    RayProgress progress = progressBefore(index);
    if (push.round > 0u && progress.segments < kSegmentSlots) {  // all its boxes were found
        RayProgressArray(frameTable.progress).at[index].segments = 0u;
        return;
    }
    progress.segments = 0u;
    if (sceneTable.mediaMask != 0u) {
        Ray ray = cameraRay(pixelOf(push.firstPixel + index), push.sampleIndex);
        SurfaceRecord surface = SurfaceRecordArray(frameTable.surfaces).at[index];
        MediaHits hits = mediaAlong(ray, surface.depth, progress.lastEntry, progress.lastBox);
        progress.segments = min(hits.count, kSegmentSlots);
        if (hits.count > 0u) {
            if (push.round == 0u) {
                progress.firstMediaId = MediaBoxArray(sceneTable.mediaBoxes).at[hits.box[0]].mediaId;
            }
            writeSegments(index, progress.segments, hits, surface);
        }
        progress.lastEntry = hits.entry[kSegmentSlots - 1];
        progress.lastBox = hits.box[kSegmentSlots - 1];
        if (hits.count > kSegmentSlots) {
            atomicAdd(CountersReference(frameTable.counters).counters.unfinished, 1u);
        }
    }
    RayProgressArray(frameTable.progress).at[index] = progress;
}
