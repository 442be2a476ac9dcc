// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// A straight part of a camera ray in haze of one kind: a segment, or neighbours of equal haze.
#ifndef NIGHTCITY_SHADERS_STRETCH_GLSL
#define NIGHTCITY_SHADERS_STRETCH_GLSL

#include "addresses.glsl"
#include "transport/airlight_interval.h"

struct Stretch {
    vec3 corner;        // m, of a media box, as the scene holds it
    vec3 start;         // m, from there
    vec3 direction;     // unit vector
    float span;         // m
    float extinction;   // 1/m
    float scattering;   // 1/m
    float depthBefore;  // optical depth from the eye to the begin
    uint box;           // the first, into MediaBox
};

// From a place that the scene holds to the begin, m.
vec3 beginFrom(Stretch stretch, vec3 place) {
    return (stretch.corner - place) + stretch.start;
}

Stretch stretchOf(Segment segment, float depthBefore) {
    MediaBox box = MediaBoxArray(sceneTable.mediaBoxes).at[segment.box];
    float span = length(segment.span);
    return Stretch(box.lo, segment.start, segment.span / max(span, 1e-30), span, box.extinction,
                   box.extinction * box.albedo, depthBefore, segment.box);
}

// Whether b goes on where a ends, in equal haze; a is then longer by b.
bool join(inout Stretch a, Stretch b) {
    vec3 gap = (b.corner - a.corner) + (b.start - (a.start + a.span * a.direction));
    bool goesOn = a.extinction == b.extinction && a.scattering == b.scattering &&
                  dot(gap, gap) < 1e-6;
    a.span += goesOn ? b.span : 0.0;
    return goesOn;
}

#endif
