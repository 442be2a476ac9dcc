// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// All that the passes ask of the scene's geometry, and the only place that
// knows ray queries: a device without them is served by another such file.
#ifndef NIGHTCITY_SHADERS_INTERSECT_GLSL
#define NIGHTCITY_SHADERS_INTERSECT_GLSL

#extension GL_EXT_ray_query : require

#include "box_interval.glsl"
#include "camera_ray.glsl"
#include "occluders.glsl"
#include "pane.glsl"
#include "triangle_hit.glsl"

layout(set = 0, binding = NIGHTCITY_BINDING_STRUCTURE) uniform accelerationStructureEXT structure;

const float kFar = 1e10;  // m, beyond every surface; frame.h's kSkyDepth

// The nearest triangle on [0, end) of a ray.
TriangleHit nearestTriangle(Ray ray, float end) {
    TriangleHit none = TriangleHit(end, kNone, vec2(0.0), vec3(0.0));
    if ((sceneTable.surfaceMask & kMaskTriangles) == 0u) {
        return none;
    }
    rayQueryEXT query;
    rayQueryInitializeEXT(query, structure, gl_RayFlagsOpaqueEXT, kMaskTriangles, ray.origin, 0.0,
                          ray.direction, end);
    while (rayQueryProceedEXT(query)) {
    }
    if (rayQueryGetIntersectionTypeEXT(query, true) !=
        gl_RayQueryCommittedIntersectionTriangleEXT) {
        return none;
    }
    TriangleHit hit = planeHit(ray, rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
    if (!inside(hit)) {  // on an edge, or seen edge on: as the device has it
        hit.depth = rayQueryGetIntersectionTEXT(query, true);
        hit.barycentrics = rayQueryGetIntersectionBarycentricsEXT(query, true);
    }
    return hit;
}

struct PaneHit {
    float depth;
    uint window;  // into Window, or kNone
};

// The nearest pane that stands on no facade and that the surface at depth `wall` does not hide.
PaneHit nearestLoosePane(Ray ray, float wall) {
    PaneHit hit = PaneHit(kFar, kNone);
    if ((sceneTable.surfaceMask & kMaskLoosePanes) == 0u) {
        return hit;
    }
    rayQueryEXT query;
    rayQueryInitializeEXT(query, structure, gl_RayFlagsNoneEXT, kMaskLoosePanes, ray.origin, 0.0,
                          ray.direction, kFar);
    while (rayQueryProceedEXT(query)) {
        uint primitive = rayQueryGetIntersectionPrimitiveIndexEXT(query, false);
        uint index = UintArray(sceneTable.looseWindows).at[primitive];
        Window window = WindowArray(sceneTable.windows).at[index];
        float depth = paneDepth(ray, window);
        if (depth > 0.0 && depth < hit.depth && !hiddenBy(wall, ray, window, depth)) {
            hit = PaneHit(depth, index);
        }
    }
    return hit;
}

// Entry, exit and index of the media boxes on a ray, by (entry, index).
struct MediaHits {
    float entry[kSegmentSlots];
    float exit[kSegmentSlots];
    uint box[kSegmentSlots];
    uint count;  // of all that lie after the pair asked for, also those without a slot
};

bool before(float entryA, uint boxA, float entryB, uint boxB) {
    return entryA < entryB || (entryA == entryB && boxA < boxB);
}

// Sorts one box in. Every slot is touched with a constant index, so that the
// list stays in registers.
void insertMedium(inout MediaHits hits, float entry, float exit, uint box) {
    for (uint slot = 0; slot < kSegmentSlots; ++slot) {
        bool swap = before(entry, box, hits.entry[slot], hits.box[slot]);
        float laterEntry = swap ? hits.entry[slot] : entry;
        float laterExit = swap ? hits.exit[slot] : exit;
        uint laterBox = swap ? hits.box[slot] : box;
        hits.entry[slot] = swap ? entry : hits.entry[slot];
        hits.exit[slot] = swap ? exit : hits.exit[slot];
        hits.box[slot] = swap ? box : hits.box[slot];
        entry = laterEntry;
        exit = laterExit;
        box = laterBox;
    }
    ++hits.count;
}

// The first media boxes on [0, end) of a ray that come after (lastEntry,
// lastBox) in the order of entry and index; in the first round lastEntry is
// negative. The structure's boxes are inflated: it only proposes.
MediaHits mediaAlong(Ray ray, float end, float lastEntry, uint lastBox) {
    MediaHits hits;
    for (uint slot = 0; slot < kSegmentSlots; ++slot) {
        hits.entry[slot] = kFar;
        hits.exit[slot] = kFar;
        hits.box[slot] = kNone;
    }
    hits.count = 0;
    vec3 inverse = reciprocal(ray.direction);
    rayQueryEXT query;
    rayQueryInitializeEXT(query, structure, gl_RayFlagsNoneEXT, kMaskMedia, ray.origin,
                          max(lastEntry, 0.0), ray.direction, end);
    while (rayQueryProceedEXT(query)) {
        uint box = rayQueryGetIntersectionPrimitiveIndexEXT(query, false);
        vec3 lo = MediaBoxArray(sceneTable.mediaBoxes).at[box].lo;
        vec3 hi = MediaBoxArray(sceneTable.mediaBoxes).at[box].hi;
        float entry, exit;
        boxInterval(ray.origin, ray.direction, inverse, lo, hi, end, entry, exit);
        if (entry < exit && before(lastEntry, lastBox, entry, box)) {
            insertMedium(hits, entry, exit, box);
        }
    }
    return hits;
}

// mediaId of the first media box on [0, end) of a ray, or -1.
int firstMediaId(Ray ray, float end) {
    int mediaId = -1;
    if (sceneTable.mediaMask == 0u || end <= 0.0) {
        return mediaId;
    }
    float begin = kFar;
    uint first = kNone;
    vec3 inverse = reciprocal(ray.direction);
    rayQueryEXT query;
    rayQueryInitializeEXT(query, structure, gl_RayFlagsNoneEXT, kMaskMedia, ray.origin, 0.0,
                          ray.direction, end);
    while (rayQueryProceedEXT(query)) {
        uint index = rayQueryGetIntersectionPrimitiveIndexEXT(query, false);
        MediaBox box = MediaBoxArray(sceneTable.mediaBoxes).at[index];
        float entry, exit;
        boxInterval(ray.origin, ray.direction, inverse, box.lo, box.hi, end, entry, exit);
        if (entry < exit && before(entry, index, begin, first)) {
            begin = entry;
            first = index;
            mediaId = box.mediaId;
            // The device need not look further. It still finds a box that begins at the same place,
            // as the structure's are inflated by more than rounding.
            rayQueryGenerateIntersectionEXT(query, entry);
        }
    }
    return mediaId;
}

// m: a wall that lies no further behind a window's plane counts as reaching in front of it, for
// floats do not tell on which side of it the emitting point lies.
const float kOnPlane = 1e-4;

// Whether a wall or the ground stands between an emitting point of a window and another point.
bool isHidden(Window window, vec3 emitter, vec3 point) {
    if (sceneTable.groundMaterial != kNone &&
        (emitter.z < sceneTable.groundHeight) != (point.z < sceneTable.groundHeight)) {
        return true;
    }
    vec3 way = point - emitter;
    float reach = length(way);
    if ((sceneTable.surfaceMask & kMaskTriangles) == 0u || reach <= 0.0) {
        return false;
    }
    vec3 normal = outward(window);
    vec3 behind = window.centre - kOnPlane * normal;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, structure,
                          gl_RayFlagsNoOpaqueEXT | gl_RayFlagsTerminateOnFirstHitEXT,
                          kMaskTriangles, emitter, 0.0, way / reach, reach);
    while (rayQueryProceedEXT(query)) {
        uint triangle = rayQueryGetIntersectionPrimitiveIndexEXT(query, false);
        uint face = UintArray(sceneTable.triangleFace).at[triangle];
        if (!isOwnWall(OccluderFaceArray(sceneTable.occluderFaces).at[face], behind, normal)) {
            rayQueryConfirmIntersectionEXT(query);
        }
    }
    return rayQueryGetIntersectionTypeEXT(query, true) !=
           gl_RayQueryCommittedIntersectionNoneEXT;
}

#endif
