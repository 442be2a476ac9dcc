// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Optical depth between a window and a point of the haze: through every media box on the way
// where windows can be hidden, else the extinction about the point times the distance
// (design section 4).
#ifndef NIGHTCITY_SHADERS_SOURCE_DEPTH_GLSL
#define NIGHTCITY_SHADERS_SOURCE_DEPTH_GLSL

#include "haze_walk.glsl"
#include "occluders.glsl"

layout(constant_id = NIGHTCITY_CONSTANT_VISIBILITY) const uint kVisibility = 0;

layout(constant_id = NIGHTCITY_CONSTANT_UNIFORM_HAZE) const uint kUniformHaze = 0;

// Whether that depth is one extinction times the distance wherever light can go.
const bool kHazeIsUniform = kVisibility == 0u || kUniformHaze != 0u;

// From anchor + offset (anchor as the scene holds it) over `way`, m.
float sourceDepth(vec3 anchor, vec3 offset, vec3 way) {
    float distance = length(way);
    return hazeSpan(Ray(anchor + offset, way / max(distance, 1e-30)), distance).depth;
}

#endif
