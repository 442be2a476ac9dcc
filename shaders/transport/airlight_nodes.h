// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// How many nodes an air-light integral needs for a relative tolerance, and where
// they lie. Binding-free.
//
// After the tangent substitution the integrand is exp(-tau h tan psi), psi = pi/4 +
// theta/2 (Sun, Ramamoorthi, Narasimhan and Nayar 2005). What Gauss-Legendre makes
// of it depends, but for a factor of about 1.3, on two optical depths only: how much
// farther the light goes from the begin to the midpoint of the substituted variable,
// and from there to the end. Koksma's bound by their sum is a median factor of 1500
// too large; the forms that fit_airlight_nodes.py fits to both are an envelope of
// measured errors.
#ifndef NIGHTCITY_TRANSPORT_AIRLIGHT_NODES_H
#define NIGHTCITY_TRANSPORT_AIRLIGHT_NODES_H

#include "airlight_node_fit.h"
#include "gauss_legendre.h"

NIGHTCITY_BEGIN

NIGHTCITY_CONST int kAirlightIsotropic = 0;   // rows of the fit
NIGHTCITY_CONST int kAirlightLambertian = 1;

// Of the tolerance, what the clipped tail may take; the nodes take up to 0.8.
NIGHTCITY_CONST float kAirlightTailShare = 0.125f;

struct AirlightRule {
    int count;    // nodes, 1 to kGaussMost
    bool graded;  // nodes crowd towards the end: x -> 1 - x^3
    bool bySine;  // of a lobe: nodes lie in the sine, not in the angle
};

// The optical depth where an interval is clipped so that the tail is at most
// kAirlightTailShare of the tolerance. A lobe may grow with the distance from the
// begin, at most in proportion to it, hence 2 more.
NIGHTCITY_FUNCTION float airlightClipDepth(float tolerance, int emitter) {
    float depth = 0.693147181f * log2(1.0f + 1.0f / (kAirlightTailShare * tolerance));
    return emitter == kAirlightLambertian ? depth + 2.0f : depth;
}

// An upper bound of the error of one node by its two leading terms, for intervals that
// are not much wider on one side of the midpoint than on the other: a bend of t + d
// (zero for both parts alike, but for a cosine lobe), and exp over a straight line,
// depth^2 / 24. A tenth of the depth bounds it everywhere.
NIGHTCITY_FUNCTION float airlightOneNodeBound(int emitter, float first, float second) {
    float whole = first + second;
    float bend = 0.2f * abs(second - first);
    bend += emitter == kAirlightLambertian ? 0.02f * whole : 0.0f;
    return min(0.1f * whole, max(bend, whole * whole * (1.0f / 22.0f)));
}

// log2 of the error of one node, for any interval; b is log2 of the whole depth, s log2 of the whole
// over the smaller of the two parts.
NIGHTCITY_FUNCTION float airlightOneNodeError(int emitter, float b, float s) {
    int k = 6 * emitter;
    return kAirlightOne[k] + b * (kAirlightOne[k + 1] + b * kAirlightOne[k + 3]) +
           s * (kAirlightOne[k + 2] + b * kAirlightOne[k + 4] + s * kAirlightOne[k + 5]);
}

// first, second: optical depths from the begin to the midpoint and from there to the
// end. tolerance is relative, 1e-4 to 0.1.
NIGHTCITY_FUNCTION AirlightRule airlightRule(int emitter, float first, float second,
                                             float tolerance) {
    AirlightRule rule;
    rule.count = 1;
    rule.graded = false;
    rule.bySine = true;
    if (airlightOneNodeBound(emitter, first, second) <= 0.8f * tolerance) {
        return rule;
    }
    float whole = first + second;
    float b = log2(min(whole, 14.0f));
    float s = min(log2(whole) - log2(max(min(first, second), 1e-30f)), 20.0f);
    float c = -log2(tolerance);
    if (airlightOneNodeError(emitter, b, s) <= -0.322f - c) {  // 0.8 of the tolerance
        return rule;
    }
    rule.graded = second > 8.0f * first;
    int k = 10 * emitter;
    float need;
    if (rule.graded) {
        need = kAirlightGraded[k] + kAirlightGraded[k + 1] * b + kAirlightGraded[k + 2] * s +
               kAirlightGraded[k + 3] * c + kAirlightGraded[k + 4] * b * b +
               kAirlightGraded[k + 5] * b * s + kAirlightGraded[k + 6] * b * c +
               kAirlightGraded[k + 7] * s * s + kAirlightGraded[k + 8] * s * c +
               kAirlightGraded[k + 9] * c * c;
    } else {
        need = kAirlightPlain[k] + kAirlightPlain[k + 1] * b + kAirlightPlain[k + 2] * s +
               kAirlightPlain[k + 3] * c + kAirlightPlain[k + 4] * b * b +
               kAirlightPlain[k + 5] * b * s + kAirlightPlain[k + 6] * b * c +
               kAirlightPlain[k + 7] * s * s + kAirlightPlain[k + 8] * s * c +
               kAirlightPlain[k + 9] * c * c;
    }
    rule.count = clamp(int(ceil(need)) + 1, 2, kGaussMost);
    // The sine has no derivative where cos = 0: many nodes are better spent on the angle,
    // unless the lobe is all there is to integrate.
    rule.bySine = rule.graded || rule.count <= 3 || whole < 0.02f;
    return rule;
}

// (share of the substituted variable from the begin, weight) of a node.
NIGHTCITY_FUNCTION vec2 airlightNode(AirlightRule rule, int index) {
    vec2 node = gaussNode(rule.count, index);
    if (!rule.graded) {
        return node;
    }
    float square = node.x * node.x;
    return vec2(1.0f - square * node.x, 3.0f * square * node.y);
}

NIGHTCITY_END

#endif
