// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Light of a point that is scattered once towards the eye, integrated along a
// visible part of the ray in homogeneous haze of extinction tau:
//
//   isotropic    Int exp(-tau (t + d)) / d^2 dt
//   lambertian   Int max(cos, 0) exp(-tau (t + d)) / d^2 dt
//
// in 1/m, by Gauss-Legendre after a substitution that takes 1 / d^2, or cos / d^2,
// away. Times the radiant intensity (P / 4 pi, P / pi) this is the integral of the
// fluence; times sigma_s / 4 pi that of the glow. Binding-free.
//
// dt / d^2 = dtheta / h with tan theta = u / h: Macklin 2010, In-scattering demo
// (tau = 0); Kulla and Fajardo 2012, Importance sampling techniques for path tracing
// in participating media, section 4; Sun et al. 2005, A practical analytic single
// scattering model, equation 9 (tau > 0).
#ifndef NIGHTCITY_TRANSPORT_AIRLIGHT_H
#define NIGHTCITY_TRANSPORT_AIRLIGHT_H

#include "airlight_interval.h"
#include "airlight_nodes.h"
#include "polynomial_trig.h"

NIGHTCITY_BEGIN

// Metres from the begin to where the direction from the emitter has turned by an
// angle of which these are sine and cosine, times any common factor > 0. With
// u - ua = sin d_a^2 / (h cos - ua sin) no difference of large numbers appears.
NIGHTCITY_FUNCTION float airlightStep(AirlightInterval i, float sine, float cosine) {
    float across = max(i.h * cosine - i.ua * sine, 1e-30f);
    return clamp(sine * (i.da * i.da / across), 0.0f, i.span);
}

NIGHTCITY_FUNCTION float airlightDistance(AirlightInterval i, float step) {
    float u = i.ua + step;
    return sqrt(i.h * i.h + u * u);
}

// exp(-tau (t + d)): never exp(-tau t) alone, which overflows for a light behind
// the eye where t is counted from the foot.
NIGHTCITY_FUNCTION float airlightAttenuation(AirlightInterval i, float extinction, float step,
                                             float d) {
    return exp(-extinction * (i.begin + step + d));
}

// The angle under which the emitter sees the interval, rad: one arc, not the
// difference of two.
NIGHTCITY_FUNCTION float airlightArc(AirlightInterval i) {
    return arcOf(i.h * i.span, i.h * i.h + i.ua * i.ub);
}

// Metres from the foot to there: exact to a small part of h beside the foot, however far from the
// begin.
NIGHTCITY_FUNCTION float airlightFromFoot(AirlightInterval i, float sine, float cosine) {
    float across = max(i.h * cosine - i.ua * sine, 1e-30f);
    return clamp((i.ua * cosine + i.h * sine) * (i.h / across), i.ua, i.ub);
}

// Sine and cosine of a share of an arc.
NIGHTCITY_FUNCTION vec2 airlightTurn(float arc, float share) {
    vec2 side = quarterTurn(0.5f * arc * share);
    return vec2(2.0f * side.x * side.y, side.y * side.y - side.x * side.x);
}

// Metres from the begin to a share of the arc.
NIGHTCITY_FUNCTION float airlightStepOfArc(AirlightInterval i, float arc, float share) {
    vec2 turn = airlightTurn(arc, share);
    return airlightStep(i, turn.x, turn.y);
}

// Optical depths from the begin to the point `step` m after it, and from there to the
// end: what airlightRule asks for.
NIGHTCITY_FUNCTION vec2 airlightDepths(AirlightInterval i, float extinction, float step, float d) {
    float first = airlightDetour(i, step, d);
    float whole = airlightDetour(i, i.span, i.db);
    return extinction * vec2(first, max(whole - first, 0.0f));
}

// extinction in 1/m, 0 to 10; tolerance relative, 1e-4 to 0.1.
NIGHTCITY_FUNCTION float airlightIsotropic(AirlightInterval interval, float extinction,
                                           float tolerance) {
    AirlightInterval i = airlightClipped(interval, extinction,
                                         airlightClipDepth(tolerance, kAirlightIsotropic));
    float arc = airlightArc(i);
    float middle = i.span * i.da / (i.da + i.db);  // where the arc is halved
    float d = airlightDistance(i, middle);
    vec2 depths = airlightDepths(i, extinction, middle, d);
    AirlightRule rule = airlightRule(kAirlightIsotropic, depths.x, depths.y, tolerance);
    if (rule.count == 1) {
        return arc / i.h * airlightAttenuation(i, extinction, middle, d);
    }
    float sum = 0.0f;
    for (int index = 0; index < rule.count; ++index) {
        vec2 node = airlightNode(rule, index);
        float step = airlightStepOfArc(i, arc, node.x);
        d = airlightDistance(i, step);
        sum += node.y * airlightAttenuation(i, extinction, step, d);
    }
    return arc / i.h * sum;
}

NIGHTCITY_END

#endif
