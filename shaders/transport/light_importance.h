// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// How likely a node of the tree of lights is chosen, for a point and for a part of a
// ray: power over squared distance, with bounds of the cosines. Any value keeps the
// estimate unbiased that is above 0 where a light of the node shines; it is 0 only
// where all of them are seen from behind. After Conty Estevez and Kulla 2018,
// Importance sampling of many lights with adaptive tree splitting. Binding-free.
#ifndef NIGHTCITY_TRANSPORT_LIGHT_IMPORTANCE_H
#define NIGHTCITY_TRANSPORT_LIGHT_IMPORTANCE_H

#include "../shared/dispatch.h"
#include "airlight.h"

NIGHTCITY_BEGIN

NIGHTCITY_FUNCTION vec3 nodeCentre(LightNode node) {
    return 0.5f * (node.lo + node.hi);
}

NIGHTCITY_FUNCTION float squared(vec3 v) {
    return dot(v, v);
}

// Of the sphere about the node's bounds, m^2.
NIGHTCITY_FUNCTION float nodeRadius2(LightNode node) {
    return 0.25f * squared(node.hi - node.lo);
}

// cos(max(a - b, 0)) of two angles in [0, pi].
NIGHTCITY_FUNCTION vec2 lesserAngle(vec2 a, vec2 b) {  // (cosine, sine) each
    return a.x > b.x ? vec2(1.0f, 0.0f)
                     : vec2(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y);
}

NIGHTCITY_FUNCTION vec2 withSine(float cosine) {
    return vec2(cosine, sqrt(max(1.0f - cosine * cosine, 0.0f)));
}

// Bound of the cosine between any normal of the node and the way from any of its
// points to `point`; 0 where all are seen from behind.
NIGHTCITY_FUNCTION float facingCosine(LightNode node, vec3 point) {
    vec3 way = point - nodeCentre(node);
    float distance2 = squared(way);
    float radius2 = nodeRadius2(node);
    if (node.coneCos <= -1.0f || distance2 <= radius2) {
        return 1.0f;
    }
    float cosine = clamp(dot(node.axis, way) / sqrt(distance2), -1.0f, 1.0f);
    vec2 angle = lesserAngle(withSine(cosine), withSine(node.coneCos));
    float sineOfSize2 = radius2 / distance2;
    angle = lesserAngle(angle, vec2(sqrt(1.0f - sineOfSize2), sqrt(sineOfSize2)));
    return max(angle.x, 0.0f);
}

// For a point in haze of `extinction` (1/m).
NIGHTCITY_FUNCTION float importanceAt(LightNode node, vec3 point, float extinction, bool cosines) {
    float distance2 = squared(point - nodeCentre(node));
    float radius2 = nodeRadius2(node);
    float clear = max(sqrt(distance2) - sqrt(radius2), 0.0f);
    float attenuation = exp(-min(extinction * clear, 40.0f));
    float facing = cosines ? facingCosine(node, point) : 1.0f;
    return node.power * attenuation * facing / max(max(distance2, radius2), 1e-6f);
}

// The interval as a sphere of radius^2 about the emitter sees it: 1 / (d^2 + radius^2)
// has no peak sharper than the emitter.
NIGHTCITY_FUNCTION AirlightInterval softened(AirlightInterval i, float radius2) {
    i.h = sqrt(i.h * i.h + radius2);
    i.da = sqrt(i.h * i.h + i.ua * i.ua);
    i.db = sqrt(i.h * i.h + i.ub * i.ub);
    return i;
}

// For the part [begin, end] (m) of a ray whose direction is a unit vector.
NIGHTCITY_FUNCTION float importanceAlong(LightNode node, vec3 origin, vec3 direction, float begin,
                                         float end, bool cosines) {
    vec3 centre = nodeCentre(node);
    AirlightInterval i = softened(airlightInterval(origin - centre, direction, begin, end),
                                  nodeRadius2(node));
    float facing = 1.0f;
    if (cosines) {
        float nearest = clamp(begin - i.ua, begin, end);
        float atBegin = facingCosine(node, origin + begin * direction);
        float atEnd = facingCosine(node, origin + end * direction);
        float atNearest = facingCosine(node, origin + nearest * direction);
        // Behind at both ends is behind everywhere: the bright side is convex.
        facing = atBegin <= 0.0f && atEnd <= 0.0f ? 0.0f : 0.05f + 0.95f * atNearest;
    }
    return node.power * facing * airlightArc(i) / i.h;
}

NIGHTCITY_END

#endif
