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

// Whether the media box about a point lists a window.
bool isListedAt(vec3 point, uint window) {
    if (sceneTable.mediaNodes == uvec2(0)) {
        return false;
    }
    BoxNodeArray nodes = BoxNodeArray(sceneTable.mediaNodes);
    uint count = nodes.at[0].next;
    for (uint walk = 0u; walk < count;) {
        BoxNode node = nodes.at[walk];
        bool isInside =
            all(lessThanEqual(node.lo, point)) && all(lessThan(point, node.hi));
        if (isInside && node.item != kNone) {
            return isListed(MediaBoxArray(sceneTable.mediaBoxes).at[node.item], window);
        }
        walk = isInside ? walk + 1u : node.next;
    }
    return false;
}

// The part of the span on the bright side of a window, softened by its size.
AirlightInterval brightInterval(Ray ray, HazeSpan span, Window window) {
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
    HazePoint haze;
    uint window;      // or kNone
    vec3 fromWindow;  // m, from the window's centre
    float byFlight;
    float byAngle;
};

LightQuery lightsAlong(Ray ray, HazeSpan span, float nearShare) {
    return LightQuery(ray, span.begin, span.end, 0.0, nearShare);
}

float flightDensity(HazePoint haze, HazeSpan span) {
    return haze.extinction * exp(-haze.depth) / collisionProbability(span.depth);
}

// `u` m after the foot.
float angleDensity(AirlightInterval interval, float u) {
    bool isOutside = u < interval.ua || u > interval.ub || interval.span <= 0.0;
    float d2 = interval.h * interval.h + u * u;
    return isOutside ? 0.0 : interval.h / (airlightArc(interval) * d2);
}

ScatteringPoint drawByFlight(Ray ray, HazeSpan span, float nearShare, inout RandomStream random) {
    float share = nextRandom(random) * collisionProbability(span.depth);
    ScatteringPoint point;
    point.haze = hazeAtDepth(ray, span.end, depthOfShare(share));
    vec3 place = ray.origin + point.haze.distance * ray.direction;
    LightChoice light = chooseLight(lightsAt(place, point.haze.extinction), random);
    point.window = light.window;
    if (light.window != kNone) {
        Window window = WindowArray(sceneTable.windows).at[light.window];
        point.byFlight = light.probability * flightDensity(point.haze, span);
        AirlightInterval interval = brightInterval(ray, span, window);
        float u = interval.ua + (point.haze.distance - interval.begin);
        point.fromWindow = interval.foot + u * ray.direction;
        point.byAngle = angleDensity(interval, u);
        if (point.byAngle > 0.0) {
            point.byAngle *= lightProbability(lightsAlong(ray, span, nearShare), light.window);
        }
    }
    return point;
}

ScatteringPoint drawByAngle(Ray ray, HazeSpan span, float nearShare, inout RandomStream random) {
    ScatteringPoint point;
    LightChoice light = chooseLight(lightsAlong(ray, span, nearShare), random);
    point.window = kNone;
    if (light.window == kNone) {
        return point;
    }
    AirlightInterval interval =
        brightInterval(ray, span, WindowArray(sceneTable.windows).at[light.window]);
    if (interval.span <= 0.0) {
        return point;
    }
    vec2 turn = airlightTurn(airlightArc(interval), nextRandom(random));
    float distance = interval.begin + airlightStep(interval, turn.x, turn.y);
    point.haze = hazeAtDistance(ray, distance);
    if (point.haze.extinction <= 0.0) {
        return point;
    }
    point.window = light.window;
    // From the foot, not from the distance along the ray, which is known to micrometres only: a
    // light as near as that would be met by some of its density's peak.
    float u = airlightFromFoot(interval, turn.x, turn.y);
    point.fromWindow = interval.foot + u * ray.direction;
    point.byAngle = light.probability * angleDensity(interval, u);
    point.byFlight =
        flightDensity(point.haze, span) *
        lightProbability(lightsAt(ray.origin + distance * ray.direction, point.haze.extinction),
                         light.window);
    return point;
}

// Radiance, W m^-2 sr^-1. `span` is the haze on the ray up to its surface, `nearShare` the
// share of choices for nearLights, where they were found for this ray, else 0.
vec3 inScatteredLight(Ray ray, HazeSpan span, float nearShare, inout RandomStream random) {
    if (span.depth <= 0.0) {
        return vec3(0.0);
    }
    ScatteringPoint point;
    if (nextRandom(random) < 0.5) {
        point = drawByFlight(ray, span, nearShare, random);
    } else {
        point = drawByAngle(ray, span, nearShare, random);
    }
    if (point.window == kNone) {
        return vec3(0.0);
    }
    HazePoint haze = point.haze;
    vec3 place = ray.origin + haze.distance * ray.direction;
    float density = 0.5 * (point.byFlight + point.byAngle);
    if ((kListed != 0u && !isListedAt(place, point.window)) || density <= 0.0) {
        return vec3(0.0);
    }
    DirectLight light =
        directLight(point.window, place, point.fromWindow, haze.extinction, random);
    float phase = phaseFunction(frameTable.anisotropy, dot(light.direction, ray.direction));
    return haze.scattering * exp(-haze.depth) * phase / density * light.fluence;
}

#endif
