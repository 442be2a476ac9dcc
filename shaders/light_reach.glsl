// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The windows that light a stretch, by the tree over them, near ones first. A node is left out
// only where all that it can add is below its share, by power, of a quarter of the tolerance
// of what was found before, or where all its windows are seen from behind. What was found in
// stretches before counts by this one's share of the optical depth up to its end, so that haze in
// many boxes loses no more than haze in one, but for a factor that grows as their logarithm.
#ifndef NIGHTCITY_SHADERS_LIGHT_REACH_GLSL
#define NIGHTCITY_SHADERS_LIGHT_REACH_GLSL

#include "transport/light_importance.h"
#include "window_light.glsl"

layout(constant_id = NIGHTCITY_CONSTANT_LISTED) const uint kListed = 1;

const uint kDeepestNode = 32u;  // levels of the tree
const float kLeftOut = 0.25;    // of the tolerance

uint openNodes[kDeepestNode];

float meanOf(vec3 colour) {
    return (colour.r + colour.g + colour.b) / 3.0;
}

// Of the optical depth up to the end of the stretch.
float shareOfDepth(Stretch stretch) {
    float depth = stretch.extinction * stretch.span;
    return depth / (stretch.depthBefore + depth);
}

// From the nearest place of the stretch to a ball about `centre`, m.
float distanceTo(Stretch stretch, vec3 centre, float radius) {
    vec3 begin = beginFrom(stretch, centre);
    float t = clamp(-dot(begin, stretch.direction), 0.0, stretch.span);
    return max(length(begin + t * stretch.direction) - radius, 0.0);
}

float nodeDistance(Stretch stretch, uint index) {
    vec3 lo = LightNodeArray(sceneTable.lightNodes).at[index].lo;
    vec3 hi = LightNodeArray(sceneTable.lightNodes).at[index].hi;
    return distanceTo(stretch, 0.5 * (lo + hi), 0.0);
}

// Puts the children of an inner node on openNodes, of which `open` are there, the nearer on top.
void openChildren(uint index, LightNode node, Stretch stretch, inout uint open) {
    bool firstNearer = nodeDistance(stretch, index + 1u) <= nodeDistance(stretch, node.child);
    openNodes[open++] = firstNearer ? node.child : index + 1u;
    openNodes[open++] = firstNearer ? index + 1u : node.child;
}

// The most that 1 W can add to the stretch, as window_light.glsl measures it. 1 / d^2 over a
// line at a distance of h is at most pi / h.
float boundOf(Stretch stretch, LightNode node) {
    float radius = sqrt(nodeRadius2(node));
    float nearest = max(distanceTo(stretch, nodeCentre(node), radius), 1e-6);
    float lobe = 0.25;
    if (kEmitter != kEmitterIsotropic) {
        vec3 begin = stretch.corner + stretch.start;
        // Behind at both ends is behind everywhere: the bright side is convex.
        bool isBehind = facingCosine(node, begin) <= 0.0 &&
                        facingCosine(node, begin + stretch.span * stretch.direction) <= 0.0;
        lobe = isBehind ? 0.0 : 1.0;
    }
    float depth = kHazeIsUniform ? stretch.extinction * nearest : 0.0;
    return lobe * exp(-depth) * min(stretch.span / nearest, kHalfTurn) / nearest;
}

#endif
