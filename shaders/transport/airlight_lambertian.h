// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// airlight.h for an emitter with a cosine lobe. Binding-free.
//
// cos = (n . x) / d is linear in u over d: cos = (atFoot + slope u) / d. As a function
// of the angle phi between the emitter's normal, laid into the plane of ray and
// emitter, and the direction to the point, it is rho cos phi, so cos dtheta / h =
// (rho / h) d(sin phi): with y = sin phi the lobe is gone as 1 / d^2 is, and one node is
// exact at tau = 0. No trigonometry is needed. (An own derivation; for cosine-like
// distributions by series see Pegoraro, Schott and Slusallek 2010.)
#ifndef NIGHTCITY_TRANSPORT_AIRLIGHT_LAMBERTIAN_H
#define NIGHTCITY_TRANSPORT_AIRLIGHT_LAMBERTIAN_H

#include "airlight.h"

NIGHTCITY_BEGIN

// d cos = atFoot + slope u, in metres; at the ends of an interval too.
struct AirlightLobe {
    float atFoot;    // m
    float slope;
    float atBegin;   // m
    float atEnd;     // m
};

NIGHTCITY_FUNCTION AirlightLobe airlightLobeAtEnds(AirlightInterval i, AirlightLobe lobe) {
    lobe.atBegin = lobe.atFoot + lobe.slope * i.ua;
    lobe.atEnd = lobe.atFoot + lobe.slope * i.ub;
    return lobe;
}

NIGHTCITY_FUNCTION AirlightLobe airlightLobe(AirlightInterval i, vec3 direction, vec3 normal) {
    AirlightLobe lobe;
    lobe.atFoot = dot(normal, i.foot);
    lobe.slope = dot(normal, direction);
    return airlightLobeAtEnds(i, lobe);
}

// The part of the interval before the emitter; of span 0 where all of it is behind.
// The edge lies at u = -atFoot / slope: near the foot that is more exact than where
// the cosines of the ends put it.
NIGHTCITY_FUNCTION AirlightInterval airlightBrightPart(AirlightInterval i, AirlightLobe lobe) {
    if (lobe.atBegin <= 0.0f && lobe.atEnd <= 0.0f) {
        i.span = 0.0f;
    } else if (lobe.atBegin < 0.0f) {
        float edge = clamp(-lobe.atFoot / lobe.slope, i.ua, i.ub);
        i.begin += edge - i.ua;
        i.ua = edge;
        i.da = sqrt(i.h * i.h + edge * edge);
        i.span = i.ub - edge;
    } else if (lobe.atEnd < 0.0f) {
        i.ub = clamp(-lobe.atFoot / lobe.slope, i.ua, i.ub);
        i.db = sqrt(i.h * i.h + i.ub * i.ub);
        i.span = i.ub - i.ua;
    }
    return i;
}

// The substituted variable: y = sin phi, and x = cos phi, at the begin, and how far
// y goes to the end; area is the integral of cos / d^2 dt, 1/m.
struct AirlightSine {
    float xa, ya;
    float span;
    float area;
};

// atBegin and atEnd of the lobe are not negative here.
NIGHTCITY_FUNCTION AirlightSine airlightSine(AirlightInterval i, AirlightLobe lobe) {
    float across = lobe.atFoot / i.h;
    float rho = max(sqrt(lobe.slope * lobe.slope + across * across), 1e-20f);
    AirlightSine sine;
    sine.xa = lobe.atBegin / (i.da * rho);
    sine.ya = (across * i.ua - lobe.slope * i.h) / (i.da * rho);
    float cosine = i.h * i.h + i.ua * i.ub;  // of the arc, times da db
    if (cosine > 0.0f) {
        // sin b - sin a = (cos a + cos b) tan((b - a) / 2)
        float ends = lobe.atBegin / i.da + lobe.atEnd / i.db;
        sine.area = ends * (i.span / (i.da * i.db + cosine));
        sine.span = sine.area * i.h / rho;
    } else {
        float yb = (across * i.ub - lobe.slope * i.h) / (i.db * rho);
        sine.span = yb - sine.ya;
        sine.area = sine.span * rho / i.h;
    }
    return sine;
}

// Metres from the begin to a share of y. sin and cos of the turn from the begin by the
// addition theorem, with cos a - cos phi = (y^2 - ya^2) / (cos a + cos phi).
NIGHTCITY_FUNCTION float airlightStepOfSine(AirlightInterval i, AirlightSine sine, float share) {
    float gain = share * sine.span;
    float y = sine.ya + gain;
    float both = y + sine.ya;
    float x = sqrt(max(sine.xa * sine.xa - gain * both, 0.0f));
    float turn = gain * (sine.xa + sine.ya * both / max(sine.xa + x, 1e-20f));
    return airlightStep(i, turn, y * sine.ya + x * sine.xa);
}

// normal: unit vector, to the bright side. extinction in 1/m, 0 to 10; tolerance
// relative, 1e-4 to 0.1.
NIGHTCITY_FUNCTION float airlightLambertian(AirlightInterval interval, vec3 direction, vec3 normal,
                                            float extinction, float tolerance) {
    AirlightLobe lobe = airlightLobe(interval, direction, normal);
    AirlightInterval i = airlightBrightPart(interval, lobe);
    if (i.span <= 0.0f) {
        return 0.0f;
    }
    i = airlightClipped(i, extinction, airlightClipDepth(tolerance, kAirlightLambertian));
    lobe = airlightLobeAtEnds(i, lobe);
    lobe.atBegin = max(lobe.atBegin, 0.0f);  // an edge misses 0 by a rounding
    lobe.atEnd = max(lobe.atEnd, 0.0f);
    AirlightSine sine = airlightSine(i, lobe);
    float middle = airlightStepOfSine(i, sine, 0.5f);
    float d = airlightDistance(i, middle);
    vec2 depths = airlightDepths(i, extinction, middle, d);
    AirlightRule rule = airlightRule(kAirlightLambertian, depths.x, depths.y, tolerance);
    if (rule.count == 1) {
        return sine.area * airlightAttenuation(i, extinction, middle, d);
    }
    float arc = rule.bySine ? 0.0f : airlightArc(i);
    float sum = 0.0f;
    for (int index = 0; index < rule.count; ++index) {
        vec2 node = airlightNode(rule, index);
        float step = rule.bySine ? airlightStepOfSine(i, sine, node.x)
                                 : airlightStepOfArc(i, arc, node.x);
        d = airlightDistance(i, step);
        float cosine = rule.bySine ? 1.0f : (lobe.atBegin + lobe.slope * step) / d;
        sum += node.y * cosine * airlightAttenuation(i, extinction, step, d);
    }
    return sum * (rule.bySine ? sine.area : arc / i.h);
}

NIGHTCITY_END

#endif
