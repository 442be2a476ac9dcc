// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What the host and the passes of the bake of the far field (far_field.h) agree on. An
// address is a uvec2: low word, high word.
#ifndef NIGHTCITY_SHADERS_FAR_BAKE_H
#define NIGHTCITY_SHADERS_FAR_BAKE_H

#include "far_field.h"

NIGHTCITY_BEGIN

// Specialization constants of far_sight.comp and far_sum.comp: the model.
#define NIGHTCITY_CONSTANT_FAR_EMITTER 0     // kEmitterIsotropic and so on
#define NIGHTCITY_CONSTANT_FAR_VISIBILITY 1  // 1: opaque surfaces hide windows
// Of far_finish.comp: 1: nodes are such that straight interpolation keeps the mean over a cell
#define NIGHTCITY_CONSTANT_FAR_MEAN 2
// Of far_sum.comp.
#define NIGHTCITY_CONSTANT_FAR_PART 3      // kSumFront and so on: the entries that it adds
#define NIGHTCITY_CONSTANT_FAR_UPDATE 4    // 1: as FarBakeTable.update
#define NIGHTCITY_CONSTANT_FAR_POLYGONS 5  // 1: some faces have more than four corners

// A device that runs both sides of every branch pays for what an entry might have needed: so each
// kind has its own dispatch.
NIGHTCITY_CONST uint kSumFront = 0u;     // all but those of kCluster
NIGHTCITY_CONST uint kSumFine = 1u;      // of these, those of the smallest bricks
NIGHTCITY_CONST uint kSumCoarse = 2u;    // those of larger ones, in a scene without spheres
NIGHTCITY_CONST uint kSumClusters = 3u;  // those of kCluster

NIGHTCITY_CONST uint kBrickSideWords = (kBrickNodes + 31u) / 32u;
NIGHTCITY_CONST uint kColumnThreads = 96u;  // at least the columns of a brick
NIGHTCITY_CONST uint kFarStack = 6144u;     // lights that a group keeps for later, most
NIGHTCITY_CONST uint kFarFaces = 23u;       // of one entry
NIGHTCITY_CONST uint kMesh = 0xffu;         // sight is that from a mesh of every other node
NIGHTCITY_CONST uint kMeshSide = kBrickSteps / 2u + 1u;  // of its points along each axis
NIGHTCITY_CONST uint kRoofPlaces = 4u;     // of a light, that columns look at in turn
NIGHTCITY_CONST uint kRoofs = 0xfeu;       // sight is that over the map of heights
NIGHTCITY_CONST uint kCluster = 0x100u;     // sight is that from the brick's corners
NIGHTCITY_CONST uint kWaySide = 3u;         // of the places where the haze on the way is known
NIGHTCITY_CONST uint kWayWords = 5u;        // of a layer of them
NIGHTCITY_CONST float kNoRoof = -1e9f;     // m, where nothing opaque is but the ground
// m: a node so near to the plane of a face lies on it, and is seen from both of its sides: most
// walls lie on planes of nodes, and the air before them reads their nodes.
NIGHTCITY_CONST float kOnFace = 2e-3f;
NIGHTCITY_CONST float kClusterCos = 0.95f;  // of the widest cone of normals that is one direction

// How bricks see lights (far_sight.comp; the host asks the same, passes/far_cut.h).
NIGHTCITY_CONST float kFullSpread = 20.0f;  // near radii, up to which the spread is that of the table
NIGHTCITY_CONST float kLargestSpread = 0.4f;
NIGHTCITY_CONST float kJoinedReach = 2.67f;
NIGHTCITY_CONST uint kJoinedScale = 1u;    // of bricks whose nodes are too far apart for single windows
NIGHTCITY_CONST uint kPartLevels = 3u;      // of the tree below a light that parts of it are taken from

// A node of the tree over all windows, lit or not. The first child of an inner node follows it.
// kPartLevels below lights that no brick looks into it ends: what it ends in is a part of such a
// light, and never asked for itself.
struct FarLight {
    vec3 centre;    // m, of the bounds of its panes
    uint second;    // the second child; 0: a window, or where the tree ends
    vec3 reach;     // m, half sides of the bounds
    uint window;    // into Window; of an inner node one of its windows
    vec3 axis;      // unit vector, the mean of the normals
    float coneCos;  // of the half angle about `axis` that holds every normal; -1: all directions
    float power;    // W, of the strongest channel with all windows on
    uint medium;    // the one that holds the bounds, into FarMedium; kNone: no single one does
};

// A window that may light a brick, and what may stand between; or a cluster of windows that
// is far enough to be one point.
struct FarEntry {
    uint light;
    float extinction;  // 1/m, mean of all ways to the brick; negative: it differs
    uint faceCount;    // or kMesh, kRoofs, kCluster
    // Where it differs: 1/m, the means of the ways to 3 x 3 x 3 places of the brick, as halves,
    // those of a layer behind those of the layer below, x fastest, each layer filled to 10.
    uint ways[3u * kWayWords];
    uint face[kFarFaces];  // of a cluster: 4 bits a corner of the brick, quarters that are seen;
                           // of a mesh: a word a layer, a bit a point that sees the light;
                           // over roofs: three floats a place of the light, m from the brick's
                           // centre
};

struct FarBakeTable {
    uvec2 field;        // FarFieldTable
    uvec2 lights;       // FarLight
    uvec2 roots;        // uint into the lights: together they hold every window
    uvec2 emission;     // vec3 a light, W: of the windows that are on
    uvec2 baked;        // vec3 a light, W: what the sums hold so far
    uvec2 changed;      // uint, bit i & 31 of word i >> 5: of light i the two differ somewhere
    uvec2 mediaNodes;   // BoxNode over the media; 0: none
    uvec2 sides;        // uint, kBrickSideWords a brick: bit n is 1 where node n is in a solid
    uvec2 sums;         // uvec3 a node, in the unit of its brick
    uvec2 units;        // float a brick, W m^-2: a power of two
    uvec2 entries;      // FarEntry, entryCapacity a brick of the batch: first those from the
                        // front, last, from the end, those of kCluster
    uvec2 entryCounts;  // uvec2 a brick of the batch: of both; may be more than there is room for
    uint lightCount;
    uint rootCount;
    uint entryCapacity;
    uint update;        // 1: only windows that changed; the units stay
    float skyHeight;    // m, above all that is opaque
    float thickest;     // 1/m, the largest extinction of all media
    float boundUnit;    // W m^-2, of the sums of bounds
    uvec2 heights;      // float a cell, m: of a map seen from above, x fastest (passes/height_map.h)
    vec2 heightOrigin;  // m
    uvec2 heightCounts; // of cells
    float heightCell;   // m
    float spread;       // a cluster's half size is at most this share of its distance
};

NIGHTCITY_END

#endif
