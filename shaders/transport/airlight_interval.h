// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// A visible part of a camera ray as an emitter sees it, and the optically long
// tail that may be left out. Binding-free.
//
// u is the distance along the ray from the foot of the perpendicular from the
// emitter, h the length of that perpendicular, d = sqrt(h^2 + u^2), and t the
// distance along the ray from its origin. Light that is scattered at t has gone
// t + d, which rises with t: d(t + d)/dt = 1 + u/d > 0.
#ifndef NIGHTCITY_TRANSPORT_AIRLIGHT_INTERVAL_H
#define NIGHTCITY_TRANSPORT_AIRLIGHT_INTERVAL_H

#include "arithmetic.h"

NIGHTCITY_BEGIN

// A ray that passes a point of light within a micrometre passes it at a
// micrometre: through the point itself the integral is infinite.
NIGHTCITY_CONST float kAirlightNearest = 1e-6f;  // m

struct AirlightInterval {
    vec3 foot;     // m, from the emitter to the foot
    float h;       // m, at least kAirlightNearest
    float begin;   // t of the begin, m
    float span;    // m, not negative
    float ua, ub;  // u of begin and end, m
    float da, db;  // d of begin and end, m
};

// [begin, end] m of the ray fromEmitter + t direction; fromEmitter is the ray's
// origin less the emitter's place, direction a unit vector. Let the origin be near
// the interval (where the ray enters the medium, not the camera): the sum of all
// roundings is about 1e-7 of fromEmitter. The foot is q - o - delta w, with what
// rounding left along the ray taken off, never sqrt(|q - o|^2 - delta^2), whose
// difference loses all digits of a short h.
NIGHTCITY_FUNCTION AirlightInterval airlightInterval(vec3 fromEmitter, vec3 direction, float begin,
                                                     float end) {
    float delta = -dot(fromEmitter, direction);
    vec3 foot = fromEmitter + delta * direction;
    float rest = dot(foot, direction);
    delta -= rest;
    AirlightInterval i;
    i.foot = foot - rest * direction;
    float h2 = max(dot(i.foot, i.foot), kAirlightNearest * kAirlightNearest);
    i.h = sqrt(h2);
    i.begin = begin;
    i.span = max(end - begin, 0.0f);
    i.ua = begin - delta;
    i.ub = i.ua + i.span;
    i.da = sqrt(h2 + i.ua * i.ua);
    i.db = sqrt(h2 + i.ub * i.ub);
    return i;
}

// How much farther light goes that is scattered `step` m after the begin, where it
// is d m from the emitter, than light that is scattered at the begin: m, not negative.
// (t + d) less (t + d) at the begin, without its cancellation.
NIGHTCITY_FUNCTION float airlightDetour(AirlightInterval i, float step, float d) {
    return max(step * (1.0f + (2.0f * i.ua + step) / (i.da + d)), 0.0f);
}

// u + d at the begin, m: h^2 / (d - u) where that difference is a sum.
NIGHTCITY_FUNCTION float airlightReachAtBegin(AirlightInterval i) {
    return i.ua < 0.0f ? i.h * i.h / (i.da - i.ua) : i.ua + i.da;
}

// The interval up to where the light has gone `depth` / extinction m farther than
// at the begin. With X = u + d and dt / d^2 = 2 dX / (X^2 + h^2), whose factor of dX
// falls, the rest of an isotropic emitter's integral is at most 1 / (exp(depth) - 1)
// of what is kept.
NIGHTCITY_FUNCTION AirlightInterval airlightClipped(AirlightInterval i, float extinction,
                                                    float depth) {
    if (extinction * airlightDetour(i, i.span, i.db) <= depth) {
        return i;
    }
    float farther = depth / extinction;
    float reachA = airlightReachAtBegin(i);
    float reachB = reachA + farther;
    float shadow = i.h * i.h / reachB;
    i.span = min(i.span, 0.5f * farther * (1.0f + shadow / reachA));
    i.ub = i.ua + i.span;
    i.db = 0.5f * (reachB + shadow);
    return i;
}

NIGHTCITY_END

#endif
