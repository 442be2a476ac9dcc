// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Light that comes straight from one window to a point, by one random point of the
// window (design section 4).
#ifndef NIGHTCITY_SHADERS_DIRECT_LIGHT_GLSL
#define NIGHTCITY_SHADERS_DIRECT_LIGHT_GLSL

#include "haze_walk.glsl"
#include "intersect.glsl"
#include "light_tree.glsl"
#include "transport/spherical_rectangle.h"

layout(constant_id = NIGHTCITY_CONSTANT_VISIBILITY) const uint kVisibility = 0;

// A pane is sampled by solid angle nearer than this, in units of its half diagonal, and
// where that angle is not so small that its rounding counts; else by area.
const float kNearPane = 4.0;
const float kSmallSolidAngle = 0.01;  // sr

uint lightSamples = 0;  // drawn by this thread

struct DirectLight {
    vec3 fluence;    // W m^-2
    vec3 direction;  // unit vector, to the emitting point
};

// Before visibility and attenuation.
struct EmitterSample {
    vec3 place;     // of the window
    vec3 way;       // m, from the lit point to there
    float perWatt;  // m^-2, fluence of 1 W
};

EmitterSample paneSample(Window window, vec3 fromCentre, vec2 u) {
    vec2 halfSize = vec2(length(window.halfU), length(window.halfV));
    vec3 axisU = window.halfU / halfSize.x;
    vec3 axisV = window.halfV / halfSize.y;
    vec3 normal = cross(axisU, axisV);
    float height = dot(fromCentre, normal);  // m, above the pane's bright side
    if (height <= 0.0) {
        return EmitterSample(window.centre, -fromCentre, 0.0);
    }
    vec2 across = -vec2(dot(fromCentre, axisU), dot(fromCentre, axisV));
    float area = 4.0 * halfSize.x * halfSize.y;
    vec2 at = across + (2.0 * u - 1.0) * halfSize;
    bool near = squared(fromCentre) < kNearPane * kNearPane * dot(halfSize, halfSize);
    SphericalRectangle rectangle;
    if (near) {
        // The listing's z axis points away from the pane.
        rectangle = sphericalRectangle(vec3(across - halfSize, -height), 2.0 * halfSize);
        near = rectangle.solidAngle > kSmallSolidAngle;
    }
    float perWatt;
    if (near) {
        at = rectanglePoint(rectangle, u);
        perWatt = rectangle.solidAngle / (kPi * area);
    } else {
        float distance2 = dot(at, at) + height * height;
        perWatt = height / (kPi * distance2 * sqrt(distance2));
    }
    vec2 within = at - across;
    return EmitterSample(window.centre + within.x * axisU + within.y * axisV,
                         at.x * axisU + at.y * axisV - height * normal, perWatt);
}

EmitterSample sampleEmitter(Window window, vec3 fromCentre, vec2 u) {
    float distance2 = squared(fromCentre);
    float perWatt = kInverse4Pi / distance2;
    if ((window.flags & kWindowSphere) != 0u) {  // isotropic in every model, dark inside
        float outside = distance2 < squared(window.halfU) ? 0.0 : perWatt;
        return EmitterSample(window.centre, -fromCentre, outside);
    }
    if (kEmitter == kEmitterPane) {
        return paneSample(window, fromCentre, u);
    }
    if (kEmitter == kEmitterLambertian) {
        perWatt *= 4.0 * max(dot(fromCentre, paneNormal(window)), 0.0) / sqrt(distance2);
    }
    return EmitterSample(window.centre, -fromCentre, distance2 > 0.0 ? perWatt : 0.0);
}

// Between an emitting point of the window and the other. Without visibility: the haze of the
// point's own box, `extinction`, all the way.
float transmittanceTo(Window window, vec3 place, vec3 point, float extinction) {
    vec3 way = place - point;
    float reach = length(way);
    if (kVisibility == 0u) {
        return exp(-extinction * reach);
    }
    if (isHidden(window, place, point)) {
        return 0.0;
    }
    HazeSpan span = hazeSpan(Ray(point, way / reach), reach);
    return exp(-span.depth);
}

// `fromCentre`, m, leads from the window's centre to the point: right beside a window it is finer
// than the places themselves.
DirectLight directLight(uint index, vec3 point, vec3 fromCentre, float extinction,
                        inout RandomStream random) {
    ++lightSamples;
    Window window = WindowArray(sceneTable.windows).at[index];
    EmitterSample emitter = sampleEmitter(window, fromCentre, nextRandomPair(random));
    DirectLight light =
        DirectLight(vec3(0.0), emitter.way / max(length(emitter.way), 1e-20));
    if (emitter.perWatt > 0.0 &&
        squared(fromCentre) <= frameTable.reach * frameTable.reach) {
        light.fluence = emitter.perWatt *
                        transmittanceTo(window, emitter.place, point, extinction) *
                        window.power * window.colour;
    }
    return light;
}

#endif
