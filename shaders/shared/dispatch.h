// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What the host and the passes agree on: group size, bindings, specialization
// constants, the tables of addresses, and the records that one pass hands to
// the next. An address is a uvec2: low word, high word.
#ifndef NIGHTCITY_SHADERS_DISPATCH_H
#define NIGHTCITY_SHADERS_DISPATCH_H

#include "scene.h"

NIGHTCITY_BEGIN

NIGHTCITY_CONST uint kGroupSize = 256;   // threads of every pass; one thread a ray
NIGHTCITY_CONST uint kSegmentSlots = 8;  // segments a ray that one traversal hands on

// Bindings of set 0.
#define NIGHTCITY_BINDING_STRUCTURE 0
#define NIGHTCITY_BINDING_UNIFORM_PAGES 0  // of march.comp and gauss_points.comp
#define NIGHTCITY_BINDING_STORAGE_PAGES 1

// Instances of the top-level structure, by what their primitives are.
NIGHTCITY_CONST uint kMaskTriangles = 1u;    // opaque triangles
NIGHTCITY_CONST uint kMaskMedia = 2u;        // media boxes
NIGHTCITY_CONST uint kMaskLoosePanes = 4u;   // emitters that stand on no facade

// Specialization constants of march.comp; of gauss_points.comp those of the pages.
#define NIGHTCITY_CONSTANT_LIGHTS_OUTSIDE 0  // 1: light loop outside the steps
#define NIGHTCITY_CONSTANT_UNIFORM_PAGES 1   // 1: pages of uniform buffers, 0: storage
#define NIGHTCITY_CONSTANT_PAGE_COUNT 2
#define NIGHTCITY_CONSTANT_PAGE_ENTRIES 3    // LightEntry a page, a power of two
#define NIGHTCITY_CONSTANT_SUBDIVISIONS 4    // steps a segment
// Specialization constants of accumulate.comp; the first also of path.comp.
#define NIGHTCITY_CONSTANT_MEDIA 0           // 0: surface frame
#define NIGHTCITY_CONSTANT_AOVS 1            // kAovBeauty and so on (aovs.h): the images to write
// Specialization constants of surface.comp, and NIGHTCITY_CONSTANT_AOVS.
#define NIGHTCITY_CONSTANT_TASK 0            // kTaskRecords and so on
// Specialization constants of path.comp and gauss.comp: the model.
#define NIGHTCITY_CONSTANT_EMITTER 1         // kEmitterIsotropic and so on
#define NIGHTCITY_CONSTANT_VISIBILITY 2      // 1: opaque surfaces hide windows
#define NIGHTCITY_CONSTANT_LISTED 3          // 1: only the windows that a media box lists
#define NIGHTCITY_CONSTANT_LIT 4             // 1: windows light surfaces
#define NIGHTCITY_CONSTANT_UNIFORM_HAZE 5    // 1: of gauss.comp, see uniform_haze.h

// What surface.comp does.
NIGHTCITY_CONST uint kTaskRecords = 0u;  // leaves a SurfaceRecord a ray
NIGHTCITY_CONST uint kTaskImages = 1u;   // writes the images of the surface frame
NIGHTCITY_CONST uint kTaskWrite = 2u;    // writes the same images and looks at nothing

// As Emitter of settings.h.
NIGHTCITY_CONST uint kEmitterIsotropic = 0u;
NIGHTCITY_CONST uint kEmitterLambertian = 1u;
NIGHTCITY_CONST uint kEmitterPane = 2u;

// Paths a pixel in one dispatch of path.comp. Sums run over such groups, so a change
// of it changes the last bits of an image.
NIGHTCITY_CONST uint kPathsPerDispatch = 16u;
NIGHTCITY_CONST uint kNoLastOrder = 0xffffffffu;

// A media box as the march reads it.
struct MarchMedium {
    float extinction;  // 1/m
    float scattering;  // 1/m, extinction x albedo
    uint firstEntry;   // of its light list
    uint entryCount;   // runs and lights together
    uint lightCount;
};

// The light list of a box is a sequence of runs, each of lights that emit the
// same: one entry for the run, then one a light. So an evaluation reads three
// numbers, whatever the colours.
//   run:   emission per channel (W), number of lights in the mantissa of a float from 1 to 2:
//          read in two bit operations, and no denormal that a device may flush
//   light: centre relative to the lower corner of the box (m), 0
NIGHTCITY_CONST uint kRunLengthMask = 0x7fffffu;  // lights of the longest run, and the mantissa
NIGHTCITY_CONST uint kRunLengthExponent = 0x3f800000u;

// Of the kind of page that is not used, one this large is bound and never read.
NIGHTCITY_CONST uint kUnusedPageEntries = 1024u;

// A node of the tree over the lit windows. The first child of an inner node follows it.
NIGHTCITY_CONST uint kLightLeaf = 0x80000000u;
struct LightNode {
    vec3 lo;        // m, bounds of the emitting points
    float power;    // W, the mean of the channels
    vec3 hi;
    float coneCos;  // of the half angle about `axis` that holds every normal; -1: all directions
    vec3 axis;      // unit vector
    uint child;     // index of the second child, or of a window with kLightLeaf
    uint count;     // windows below
};

// A node of a tree over axis-aligned boxes, depth first: what it holds follows it, and
// `next` is the node after that. A walk needs no stack, and ends at the root's `next`.
struct BoxNode {
    vec3 lo;    // m, rounded outward
    uint next;
    vec3 hi;
    uint item;  // of a leaf, whose bounds are the item's; kNone: not a leaf
};

// A node of the tree over haze that cuts space at planes: cells of one node do not overlap, so a
// ray meets them one after the other. The side below the plane follows its node.
NIGHTCITY_CONST uint kHazeLeaf = 3u;
struct HazeNode {
    float plane;  // m
    uint axis;    // 0 to 2, or kHazeLeaf
    uint item;    // the node of the side above; of a leaf what it may hold, or kNone
};

// An opaque convex face: neighbouring triangles of one plane (renderer/scene/convex_faces.h).
struct OccluderFace {
    vec3 normal;       // unit vector, outward; 0 for a face without area
    uint firstCorner;  // into the corners, counter-clockwise seen from outside
    uint cornerCount;  // at least 3
};

struct SceneTable {
    uvec2 positions;       // vec3
    uvec2 texcoords;       // vec2; 0 where there are none
    uvec2 triangles;       // Triangle
    uvec2 materials;       // Material
    uvec2 texels;          // uint
    uvec2 windows;         // Window
    uvec2 windowOn;        // uint, bit i & 31 of word i >> 5
    uvec2 mediaBoxes;      // MediaBox
    uvec2 marchMedia;      // MarchMedium, one a media box
    uvec2 facades;         // Facade
    uvec2 cellStart;       // uint
    uvec2 cellWindow;      // uint
    uvec2 triangleFacade;  // uint, one a triangle
    uvec2 looseWindows;    // uint into Window, one a primitive of the loose panes
    float groundHeight;    // m
    uint groundMaterial;   // into Material, or kNone without a ground
    uint surfaceMask;      // kMaskTriangles and kMaskLoosePanes, where there are any
    uint mediaMask;        // kMaskMedia, where there is any
    uvec2 lightNodes;      // LightNode, the root first; 0 without lit windows
    uvec2 lightList;       // uint into Window, as MediaBox.firstLight counts them
    uvec2 lightTrails;     // uint a window: bit i says which child leads to it at level i
    uvec2 farField;        // FarFieldTable of far_field.h; 0 for methods without
    uvec2 mediaNodes;      // BoxNode over the media boxes; 0 without any
    uvec2 occluderNodes;   // BoxNode over the faces; 0 where nothing is opaque but the ground
    uvec2 occluderFaces;   // OccluderFace
    uvec2 occluderCorners; // vec3, m
    uvec2 triangleFace;    // uint a triangle: the OccluderFace that it is part of
    uvec2 haze;            // FarMedium of far_field.h: the media boxes, joined; 0 without haze
    uvec2 hazeNodes;       // HazeNode over these, the root first
    uvec2 nearField;       // NearTable of glow.h; 0 for methods without
    uvec2 trianglePlane;   // uint a triangle: those of one number lie in one plane
    uvec2 windowPlane;     // uint a window: the same number as the wall behind it
    uvec2 mediaPlanes;     // HazeNode over all media boxes, the root first; 0 for methods without
    uvec2 gaussPairs;      // float: kGaussPairs of transport/gauss_legendre.h
};

struct FrameTable {
    uvec2 pixels;       // uvec2 each, or 0: all pixels, row by row
    uvec2 samples;      // vec2, offsets from the pixel centre
    uvec2 proposals;    // uint, the triangle that the raster finds or kNone, one a pixel of the
                        // frame, row by row; 0: not rasterised
    uvec2 surfaces;     // SurfaceRecord, one a ray of the band
    uvec2 progress;     // RayProgress, one a ray of the band
    uvec2 segments;     // Segment, slot s of ray r at s * bandRays + r
    uvec2 counters;     // PassCounters
    uvec2 beauty;       // vec4, and so on: one a pixel of the band
    uvec2 glow;         // vec3
    uvec2 surface;      // vec3
    uvec2 transmittance;
    uvec2 depth;
    uvec2 normal;       // vec3
    uvec2 mediaId;
    uvec2 materialId;
    uint width;         // pixels
    uint height;
    uint bandRays;      // capacity
    uint sampleCount;
    uint centreSample;  // whose depth, normal and ids are kept
    CameraFrame camera;
    vec3 positionLow;   // m, added to camera.position: what float lost of it
    float tolerance;    // of Method::gauss, relative
    uint lightCap;      // lit windows of a media box that count, at most
    uvec2 glowTable;    // GlowTable of glow.h; 0 for methods without
    uvec2 error;        // float, one a pixel of the band; of Method::field, as cost
    uvec2 cost;         // float
    // Of the path tracer; 0 for other methods.
    uvec2 pathSums;     // PathSums, one a ray of the band
    uvec2 nearLights;   // NearLights, one a ray of the band
    uvec2 glowSquares;  // vec3, one a pixel of the band: sum over all paths of glow^2
    uvec2 glowError;    // vec3, one a pixel of the band: the standard error of glow
    uvec2 seed;
    uint paths;         // a pixel sample
    uint firstOrder;    // of scattering, from 1
    uint lastOrder;     // or kNoLastOrder
    float anisotropy;   // g of Henyey and Greenstein
    float reach;        // m, from a window's centre, beyond which it lights nothing
    uint reserved;      // 0
};

struct PushConstants {
    uvec2 scene;       // SceneTable
    uvec2 frame;       // FrameTable
    uint firstPixel;   // of the band, in the order of the frame or the pixel list
    uint pixelCount;   // of the band
    uint sampleIndex;
    uint round;        // of the traversal, or of the paths; from 0
};

// What a ray ends on: a triangle's index, a window's with this bit, the ground, or kNone.
NIGHTCITY_CONST uint kPanePrimitive = 0x80000000u;
NIGHTCITY_CONST uint kGroundPrimitive = 0xfffffffeu;

// The nearest opaque surface on a ray, as surface.comp leaves it.
struct SurfaceRecord {
    vec3 radiance;   // W m^-2 sr^-1, towards the camera
    float depth;     // m along the camera's axis, kSkyDepth for none
    vec3 normal;     // towards the camera; 0 for sky
    uint primitive;
};

// How far traversal and march have come along a ray.
struct RayProgress {
    float lastEntry;   // depth where the last segment found begins
    uint lastBox;      // and its media box: the next round goes on after this pair
    uint segments;     // of this round, at most kSegmentSlots
    int firstMediaId;  // of the first box on the ray, -1 for none
    vec3 glow;         // W m^-2 sr^-1, so far
    float opticalDepth;
};

// The part of a ray inside one media box.
struct Segment {
    vec3 start;  // m, relative to the lower corner of the box
    uint box;    // into MediaBox
    vec3 span;   // m, from start to the end
};

// The windows that are the brightest from one ray, kNone where there are fewer, and how likely
// each is chosen among them.
NIGHTCITY_CONST uint kNearLights = 8u;
struct NearLights {
    uint window[kNearLights];
    float chance[kNearLights];
};

// Over the paths of one pixel sample so far.
struct PathSums {
    vec3 glow;       // W m^-2 sr^-1
    vec3 reflected;  // W m^-2 sr^-1, by the surface that the camera sees
};

struct PassCounters {
    uint unfinished;         // rays with more segments than slots
    uint lightSegmentsLow;   // march: sum over the segments of the lights of their box; path: light samples
    uint lightSegmentsHigh;  // the same, upper 32 bits
};

NIGHTCITY_END

#endif
