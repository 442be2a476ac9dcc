// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// airlight.h for a Lambertian pane of area A:
//
//   (1 / A) Int over the visible part of the ray, Int over the solid angle of the pane,
//   exp(-tau (t + d)) domega dt                                                     (1/m)
//
// Times P / pi this is the integral of the fluence, as for airlightLambertian, which it
// becomes from afar. Finite everywhere. Visibility is that of the whole pane.
// Binding-free.
//
// How near a ray comes is measured in sides, s = (distance from the centre - half a
// diagonal) / (root mean square of the sides): a lower bound. Measured on random rays past
// panes of aspect 1 to 4, errors at p99: a point in place of the pane 0.35 / s^2; n nodes of
// the lambertian substitution with the true solid angle 0.16, 0.04, 0.01, 0.002 / s^2
// (n = 1 to 4); pieces between the pane's edges (s < 1) 0.04, 0.008, 0.002, 0.0003
// with 4, 6, 8, 12 nodes each.
#ifndef NIGHTCITY_TRANSPORT_AIRLIGHT_PANE_H
#define NIGHTCITY_TRANSPORT_AIRLIGHT_PANE_H

#include "airlight_pane_near.h"

NIGHTCITY_BEGIN

NIGHTCITY_CONST int kPaneMostParts = 8;  // along each side, where haze is thick

// s^2 times the tolerance, from where a point will do for the pane.
NIGHTCITY_CONST float kPaneAsPoint = 0.8f;

// Sides from the interval to the pane, s above.
NIGHTCITY_FUNCTION float paneSides(AirlightInterval i, float a, float b) {
    float nearest = airlightDistance(i, clamp(-i.ua, 0.0f, i.span));
    float radius = sqrt(a * a + b * b);
    return (nearest - radius) / (1.41421356f * radius);
}

NIGHTCITY_FUNCTION int paneFarNodes(float sides, float tolerance) {
    float v = 0.5f * tolerance * sides * sides;
    return v > 0.16f    ? 1
           : v > 0.04f  ? 2
           : v > 0.01f  ? 3
           : v > 2e-3f  ? 4
           : v > 5e-4f  ? 5
           : v > 2e-4f  ? 6
                        : 8;
}

// Is the pane a point, seen from s sides? Its attenuation is off by extinction times up
// to half a side / s.
NIGHTCITY_FUNCTION bool paneIsPoint(float sides, float side, float extinction, float tolerance) {
    return sides > 0.0f && sides * sides * tolerance >= kPaneAsPoint &&
           0.5f * extinction * side <= 0.3f * tolerance * sides;
}

// An interval that keeps a side away from the pane, on its bright side.
NIGHTCITY_FUNCTION float airlightPaneFar(AirlightInterval interval, PaneFrame pane,
                                         float extinction, float tolerance) {
    vec3 up = vec3(0.0f, 0.0f, 1.0f);
    AirlightInterval i = airlightClipped(interval, extinction,
                                         airlightClipDepth(tolerance, kAirlightLambertian));
    AirlightLobe lobe = airlightLobe(i, pane.direction, up);
    lobe.atBegin = max(lobe.atBegin, 0.0f);
    lobe.atEnd = max(lobe.atEnd, 0.0f);
    AirlightSine sine = airlightSine(i, lobe);
    float middle = airlightStepOfSine(i, sine, 0.5f);
    vec2 depths = airlightDepths(i, extinction, middle, airlightDistance(i, middle));
    AirlightRule rule = airlightRule(kAirlightLambertian, depths.x, depths.y, tolerance);
    int enough = paneFarNodes(paneSides(i, pane.a, pane.b), tolerance);
    if (enough > rule.count) {
        rule.count = enough;
        rule.bySine = rule.graded || enough <= 3;
    }
    float arc = rule.bySine ? 0.0f : airlightArc(i);
    float area = 4.0f * pane.a * pane.b;
    float sum = 0.0f;
    for (int index = 0; index < rule.count; ++index) {
        vec2 node = airlightNode(rule, index);
        float step = rule.bySine ? airlightStepOfSine(i, sine, node.x)
                                 : airlightStepOfArc(i, arc, node.x);
        float d = airlightDistance(i, step);
        vec3 point = i.foot + (i.ua + step) * pane.direction;
        point.z = max(lobe.atBegin + lobe.slope * step, kPaneNearest);
        float angle = paneSolidAngle(point, pane.a, pane.b);
        float mean = paneMeanDistance(area, point.z, angle);
        float value = angle / area * d * d * (rule.bySine ? d / point.z : 1.0f);
        sum += node.y * value * airlightAttenuation(i, extinction, step, mean);
    }
    return sum * (rule.bySine ? sine.area : arc / i.h);
}

// The part [from, to] of u, by what suffices there.
NIGHTCITY_FUNCTION float airlightPanePart(AirlightInterval whole, float from, float to,
                                          PaneFrame pane, float extinction, float tolerance) {
    float low = max(from, whole.ua);
    float high = min(to, whole.ub);
    if (high <= low) {
        return 0.0f;
    }
    AirlightInterval i = airlightPart(whole, low, high);
    float side = 1.41421356f * sqrt(pane.a * pane.a + pane.b * pane.b);
    float sides = paneSides(i, pane.a, pane.b);
    if (paneIsPoint(sides, side, extinction, tolerance)) {
        return airlightLambertian(i, pane.direction, vec3(0.0f, 0.0f, 1.0f), extinction,
                                  tolerance);
    }
    return sides > kPaneNearSides * 0.99f ? airlightPaneFar(i, pane, extinction, tolerance)
                                          : airlightPaneNear(i, pane, extinction, tolerance);
}

// One pane whose haze is thin across it. The ray is cut where it enters and leaves the
// neighbourhood of the pane.
NIGHTCITY_FUNCTION float airlightPaneWhole(PaneFrame pane, float begin, float end,
                                           float extinction, float tolerance) {
    vec3 up = vec3(0.0f, 0.0f, 1.0f);
    AirlightInterval i = airlightInterval(pane.origin, pane.direction, begin, end);
    i = airlightBrightPart(i, airlightLobe(i, pane.direction, up));
    if (i.span <= 0.0f) {
        return 0.0f;
    }
    float radius = sqrt(pane.a * pane.a + pane.b * pane.b);
    float around = radius * (1.0f + 1.41421356f * kPaneNearSides);
    float cut = sqrt(max(around * around - i.h * i.h, 0.0f));
    return airlightPanePart(i, i.ua, -cut, pane, extinction, tolerance) +
           airlightPanePart(i, -cut, cut, pane, extinction, tolerance) +
           airlightPanePart(i, cut, i.ub, pane, extinction, tolerance);
}

// Parts along each side, so that one mean distance will do for the attenuation of each.
NIGHTCITY_FUNCTION int paneParts(float sides, float side, float extinction, float tolerance) {
    float off = 0.15f * extinction * side / (1.0f + max(sides, 0.0f));
    return int(clamp(ceil(off / (0.5f * tolerance)), 1.0f, float(kPaneMostParts)));
}

// fromCentre: the ray's origin less the pane's centre, m; halfU, halfV as in Window.
// extinction in 1/m, 0 to 10; tolerance relative, 1e-3 to 0.1.
NIGHTCITY_FUNCTION float airlightPane(vec3 fromCentre, vec3 direction, vec3 halfU, vec3 halfV,
                                      float begin, float end, float extinction, float tolerance) {
    PaneFrame pane = paneFrame(fromCentre, direction, halfU, halfV);
    AirlightInterval i = airlightInterval(pane.origin, pane.direction, begin, end);
    float side = 1.41421356f * sqrt(pane.a * pane.a + pane.b * pane.b);
    int parts = paneParts(paneSides(i, pane.a, pane.b), side, extinction, tolerance);
    float share = 1.0f / float(parts);
    PaneFrame part = pane;
    part.a *= share;
    part.b *= share;
    float sum = 0.0f;
    for (int k = 0; k < parts * parts; ++k) {
        float column = float(2 * (k % parts) + 1) * share - 1.0f;
        float row = float(2 * (k / parts) + 1) * share - 1.0f;
        part.origin = pane.origin - vec3(column * pane.a, row * pane.b, 0.0f);
        sum += airlightPaneWhole(part, begin, end, extinction, tolerance);
    }
    return sum * share * share;
}

NIGHTCITY_END

#endif
