// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Optical depth between a window and a point of the haze: through every media box on the way
// where windows can be hidden, else the extinction about the point times the distance
// (design section 4).
#ifndef NIGHTCITY_SHADERS_SOURCE_DEPTH_GLSL
#define NIGHTCITY_SHADERS_SOURCE_DEPTH_GLSL

#include "box_interval.glsl"
#include "occluders.glsl"

layout(constant_id = NIGHTCITY_CONSTANT_VISIBILITY) const uint kVisibility = 0;

layout(constant_id = NIGHTCITY_CONSTANT_UNIFORM_HAZE) const uint kUniformHaze = 0;

// Whether that depth is one extinction times the distance wherever light can go.
const bool kHazeIsUniform = kVisibility == 0u || kUniformHaze != 0u;

// The share of the way from the origin to `way` inside a box.
float shareInside(vec3 lo, vec3 hi, vec3 way) {
    float entry, exit;
    boxInterval(vec3(0.0), way, reciprocal(way), lo, hi, 1.0, entry, exit);
    return max(exit - entry, 0.0);
}

// From anchor + offset (anchor as the scene holds it) over `way`, m.
float sourceDepth(vec3 anchor, vec3 offset, vec3 way) {
    Between between = betweenBoxAndBox(anchor, abs(offset), offset + way, vec3(0.0));
    float depth = 0.0;
    uint walk = 0u;
    for (uint box = nextBoxBetween(sceneTable.mediaNodes, walk, between); box != kNone;
         box = nextBoxBetween(sceneTable.mediaNodes, walk, between)) {
        MediaBox haze = MediaBoxArray(sceneTable.mediaBoxes).at[box];
        depth += haze.extinction * shareInside(haze.lo - anchor - offset,
                                               haze.hi - anchor - offset, way);
    }
    return depth * length(way);
}

#endif
