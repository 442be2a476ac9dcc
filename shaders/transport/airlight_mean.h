// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// airlight.h's isotropic integral by one node without choosing it: the attenuation at the
// mean of the way s = t + d over the arc, which has a closed form. Binding-free.
//
// With u = h tan theta, X = u + d = h (tan theta + sec theta), and dtheta = h du / d^2:
//
//   mean of X = (h / arc) [ln(sec theta + tan theta) - ln(cos theta)]
//             = (h / arc) ln(Xb db / (Xa da)),   s = X - ua  (t from the begin)
//
// (an own derivation). exp is convex, so that the mean of exp(-tau s) is above
// exp(-tau mean s), by at most whole^2 / 8 of it for small whole = tau (sb - sa), as no
// variance on an interval is above a quarter of its square: half of that is added, and the
// relative error is at most whole^2 / 16.
#ifndef NIGHTCITY_TRANSPORT_AIRLIGHT_MEAN_H
#define NIGHTCITY_TRANSPORT_AIRLIGHT_MEAN_H

#include "airlight_interval.h"
#include "polynomial_trig.h"

NIGHTCITY_BEGIN

NIGHTCITY_CONST float kLn2 = 0.693147181f;

// The whole depth for which the error stays below nine tenths of the tolerance.
NIGHTCITY_FUNCTION float airlightMeanReach(float tolerance) {
    return 3.8f * sqrt(tolerance);
}

// 1/m, as airlightIsotropic for t from 0 to span; times exp(-depthBefore). fromEmitter: begin
// less emitter, m. extinction span is at most half of airlightMeanReach.
NIGHTCITY_FUNCTION float airlightMean(vec3 fromEmitter, vec3 direction, float span,
                                      float extinction, float depthBefore) {
    float ua = dot(fromEmitter, direction);
    vec3 foot = fromEmitter - ua * direction;
    float h2 = max(dot(foot, foot), kAirlightNearest * kAirlightNearest);
    float h = sqrt(h2);
    float ub = ua + span;
    float da = sqrt(h2 + ua * ua);
    float db = sqrt(h2 + ub * ub);
    float perMetre = arcOf(h * span, h2 + ua * ub) / h;
    // X = u + d = h^2 / (d - u): whichever is a sum.
    bool ahead = ub < 0.0f;
    float over = (ahead ? da - ua : db + ub) * db;
    float under = (ahead ? db - ub : da + ua) * da;
    float ways = kLn2 * log2(over / max(under, 1e-20f));
    float mean = clamp(ways / perMetre - ua, da, span + db);
    float whole = extinction * (span + db - da);
    return perMetre * (1.0f + 0.0625f * whole * whole) * exp(-(extinction * mean + depthBefore));
}

NIGHTCITY_END

#endif
