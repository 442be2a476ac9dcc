// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The panes whose near parts a bundle of camera rays may meet: a walk without a stack over the
// tree of the balls of the near radius (glow.h).
#ifndef NIGHTCITY_SHADERS_NEAR_TREE_GLSL
#define NIGHTCITY_SHADERS_NEAR_TREE_GLSL

#include "camera_ray.glsl"
#include "glow.h"

NIGHTCITY_ARRAY(NearPaneArray, NearPane)

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer NearReference {
    NearTable table;
};

#ifdef NIGHTCITY_KEEP_TABLES
NearTable nearTable;

void keepNearTable() {
    nearTable = NearReference(sceneTable.nearField).table;
}
#else
#define nearTable NearReference(sceneTable.nearField).table
#endif

// m, and as a share of the distance: more than float loses in places and planes.
const float kBundleSlack = 1e-2;
const float kBundleShare = 1e-5;

// The rays of a rectangle of pixels up to a depth.
struct RayBundle {
    vec3 origin;
    vec3 left, right, low, high;  // unit vectors inward, normal to the planes of its sides
    vec3 forward;                 // unit vector
    float farthest;               // m along `forward`
};

vec3 inwardNormal(vec3 one, vec3 other, vec3 inside) {
    vec3 normal = cross(one, other);
    float size = length(normal);
    normal = size > 0.0 ? normal / size : vec3(0.0);
    return dot(normal, inside) < 0.0 ? -normal : normal;
}

// Of the pixels from `first` to `last`, inclusive.
RayBundle rayBundle(uvec2 first, uvec2 last, float farthest) {
    Ray corner = cameraRay(first, push.sampleIndex);
    vec3 topRight = cameraRay(uvec2(last.x, first.y), push.sampleIndex).direction;
    vec3 bottomLeft = cameraRay(uvec2(first.x, last.y), push.sampleIndex).direction;
    vec3 bottomRight = cameraRay(last, push.sampleIndex).direction;
    vec3 inside = corner.direction + bottomRight;
    RayBundle bundle;
    bundle.origin = corner.origin;
    bundle.left = inwardNormal(corner.direction, bottomLeft, inside);
    bundle.right = inwardNormal(topRight, bottomRight, inside);
    bundle.high = inwardNormal(corner.direction, topRight, inside);
    bundle.low = inwardNormal(bottomLeft, bottomRight, inside);
    bundle.forward = frameTable.camera.forward;
    bundle.farthest = farthest;
    return bundle;
}

// Whether some of the box is on the inner side of the plane: its centre and half sides, m.
bool reaches(vec3 normal, vec3 centre, vec3 halfSides, float slack) {
    return dot(normal, centre) + dot(abs(normal), halfSides) >= -slack;
}

bool mayMeet(RayBundle bundle, BoxNode node) {
    vec3 centre = 0.5 * (node.lo + node.hi) - bundle.origin;
    vec3 halfSides = 0.5 * (node.hi - node.lo);
    float slack = kBundleSlack + kBundleShare * (abs(centre.x) + abs(centre.y) + abs(centre.z));
    return reaches(bundle.left, centre, halfSides, slack) &&
           reaches(bundle.right, centre, halfSides, slack) &&
           reaches(bundle.low, centre, halfSides, slack) &&
           reaches(bundle.high, centre, halfSides, slack) &&
           reaches(bundle.forward, centre, halfSides, slack) &&
           dot(bundle.forward, centre) - dot(abs(bundle.forward), halfSides) <=
               bundle.farthest + slack;
}

bool isPaneLit(uint pane) {
    uint window = UintArray(nearTable.windows).at[pane];
    return (UintArray(sceneTable.windowOn).at[window >> 5] >> (window & 31u) & 1u) != 0u;
}

// The next lit pane that the bundle may meet, or kNone. `walk` is 0 at first, and afterwards
// the node after it.
uint nextNearPane(RayBundle bundle, inout uint walk) {
    uvec2 tree = nearTable.tree;
    if (tree == uvec2(0)) {
        return kNone;
    }
    uint end = BoxNodeArray(tree).at[0].next;
    while (walk < end) {
        BoxNode node = BoxNodeArray(tree).at[walk];
        bool meets = mayMeet(bundle, node);
        walk = meets ? walk + 1u : node.next;
        if (meets && node.item != kNone && isPaneLit(node.item)) {
            return node.item;
        }
    }
    return kNone;
}

#endif
