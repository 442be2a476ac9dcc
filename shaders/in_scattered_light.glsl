// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Light of the windows that the haze on a ray scatters once towards its origin, by one
// random window and point. Two ways to draw them: the point by free flight, then the
// window for the point; or the window for the ray, then the point by equal angles at the
// window (Kulla and Fajardo 2012, Importance sampling techniques for path tracing in
// participating media). One of the two is taken at random and weighted by both: Veach and
// Guibas 1995, the balance heuristic with one sample.
#ifndef NIGHTCITY_SHADERS_IN_SCATTERED_LIGHT_GLSL
#define NIGHTCITY_SHADERS_IN_SCATTERED_LIGHT_GLSL

#include "direct_light.glsl"
#include "transport/free_flight.h"
#include "transport/phase.h"

layout(constant_id = NIGHTCITY_CONSTANT_LISTED) const uint kListed = 1;
layout(constant_id = NIGHTCITY_CONSTANT_MEDIA) const uint kMedia = 1;

// Whether a media box lists a window; lists are ascending.
bool isListed(MediaBox box, uint window) {
    uint first = box.firstLight;
    uint end = first + box.lightCount;
    while (first < end) {
        uint middle = first + (end - first) / 2u;
        uint found = UintArray(sceneTable.lightList).at[middle];
        if (found == window) {
            return true;
        }
        if (found < window) {
            first = middle + 1u;
        } else {
            end = middle;
        }
    }
    return false;
}

// The part of the span on the bright side of a window, softened by its size.
AirlightInterval brightInterval(Ray ray, MediaSpan span, Window window) {
    vec3 fromWindow = ray.origin - window.centre;
    float begin = span.begin;
    float end = span.end;
    if (kEmitter == kEmitterIsotropic || (window.flags & kWindowSphere) != 0u) {
        return airlightInterval(fromWindow, ray.direction, begin, end);
    }
    vec3 normal = paneNormal(window);
    float height = dot(fromWindow, normal);
    float slope = dot(ray.direction, normal);
    float crossing = -height / (abs(slope) > 1e-12 ? slope : 1e-12);
    if (abs(slope) <= 1e-12) {
        end = height > 0.0 ? end : begin;
    } else if (slope > 0.0) {
        begin = max(begin, crossing);
    } else {
        end = min(end, crossing);
    }
    AirlightInterval interval = airlightInterval(fromWindow, ray.direction, begin, end);
    if (kEmitter == kEmitterPane) {
        interval = softened(interval, squared(window.halfU) + squared(window.halfV));
    }
    return interval;
}

// A point of the haze on a ray, a window, and the density of drawing both (1/m).
struct ScatteringPoint {
    MediumPoint medium;
    uint window;  // or kNone
    float byFlight;
    float byAngle;
};

float flightDensity(MediumPoint medium, float extinction, MediaSpan span) {
    return extinction * exp(-medium.depth) / collisionProbability(span.depth);
}

float angleDensity(AirlightInterval interval, float distance) {
    float step = distance - interval.begin;
    if (step < 0.0 || step > interval.span || interval.span <= 0.0) {
        return 0.0;
    }
    float u = interval.ua + step;
    return interval.h / (airlightArc(interval) * (interval.h * interval.h + u * u));
}

float extinctionOf(uint box) {
    return MediaBoxArray(sceneTable.mediaBoxes).at[box].extinction;
}

ScatteringPoint drawByFlight(Ray ray, MediaSpan span, inout RandomStream random) {
    float share = nextRandom(random) * collisionProbability(span.depth);
    ScatteringPoint point;
    point.medium = mediumAtDepth(ray, span.end, depthOfShare(share));
    float extinction = extinctionOf(point.medium.box);
    vec3 place = ray.origin + point.medium.distance * ray.direction;
    LightChoice light = chooseLight(lightsAt(place, extinction), random);
    point.window = light.window;
    if (light.window != kNone) {
        Window window = WindowArray(sceneTable.windows).at[light.window];
        point.byFlight = light.probability * flightDensity(point.medium, extinction, span);
        point.byAngle = angleDensity(brightInterval(ray, span, window), point.medium.distance);
        if (point.byAngle > 0.0) {
            point.byAngle *=
                lightProbability(lightsAlong(ray, span.begin, span.end), light.window);
        }
    }
    return point;
}

ScatteringPoint drawByAngle(Ray ray, MediaSpan span, inout RandomStream random) {
    ScatteringPoint point;
    LightChoice light = chooseLight(lightsAlong(ray, span.begin, span.end), random);
    point.window = kNone;
    if (light.window == kNone) {
        return point;
    }
    AirlightInterval interval =
        brightInterval(ray, span, WindowArray(sceneTable.windows).at[light.window]);
    if (interval.span <= 0.0) {
        return point;
    }
    float distance = interval.begin +
                     airlightStepOfArc(interval, airlightArc(interval), nextRandom(random));
    point.medium = mediumAtDistance(ray, distance);
    if (point.medium.box == kNone) {
        return point;
    }
    point.window = light.window;
    float extinction = extinctionOf(point.medium.box);
    point.byAngle = light.probability * angleDensity(interval, distance);
    point.byFlight =
        flightDensity(point.medium, extinction, span) *
        lightProbability(lightsAt(ray.origin + distance * ray.direction, extinction), light.window);
    return point;
}

// Radiance, W m^-2 sr^-1. `span` is the haze on the ray up to its surface.
vec3 inScatteredLight(Ray ray, MediaSpan span, inout RandomStream random) {
    if (span.depth <= 0.0) {
        return vec3(0.0);
    }
    ScatteringPoint point;
    if (nextRandom(random) < 0.5) {
        point = drawByFlight(ray, span, random);
    } else {
        point = drawByAngle(ray, span, random);
    }
    if (point.window == kNone) {
        return vec3(0.0);
    }
    MediaBox box = MediaBoxArray(sceneTable.mediaBoxes).at[point.medium.box];
    float density = 0.5 * (point.byFlight + point.byAngle);
    if ((kListed != 0u && !isListed(box, point.window)) || density <= 0.0) {
        return vec3(0.0);
    }
    vec3 place = ray.origin + point.medium.distance * ray.direction;
    DirectLight light = directLight(point.window, place, box.extinction, random);
    float phase = phaseFunction(frameTable.anisotropy, dot(light.direction, ray.direction));
    return box.extinction * box.albedo * exp(-point.medium.depth) * phase / density * light.fluence;
}

#endif
