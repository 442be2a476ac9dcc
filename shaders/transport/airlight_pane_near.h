// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// airlight_pane.h for the part of a ray that is within a side of the pane. The solid
// angle changes only where the ray passes an edge of the pane, over as short a way as the
// edge is near: along a ray that grazes the pane it is a plateau of 2 pi with steep flanks.
// The part is cut at its nearest points to the edges, and the nodes crowd there.
// Binding-free.
#ifndef NIGHTCITY_TRANSPORT_AIRLIGHT_PANE_NEAR_H
#define NIGHTCITY_TRANSPORT_AIRLIGHT_PANE_NEAR_H

#include "airlight_lambertian.h"
#include "pane_solid_angle.h"

NIGHTCITY_BEGIN

// Sides (airlight_pane.h) within which a ray is near a pane.
NIGHTCITY_CONST float kPaneNearSides = 1.0f;

// The part [low, high] of u of an interval.
NIGHTCITY_FUNCTION AirlightInterval airlightPart(AirlightInterval i, float low, float high) {
    i.begin += low - i.ua;
    i.span = high - low;
    i.ua = low;
    i.ub = high;
    i.da = sqrt(i.h * i.h + low * low);
    i.db = sqrt(i.h * i.h + high * high);
    return i;
}

// u where the ray is nearest to the edge of the pane from `corner` to corner + `edge`: the
// nearest points of two lines, each held to its segment (Ericson 2005, Real-time
// collision detection, section 5.1.9). foot is perpendicular to direction.
NIGHTCITY_FUNCTION float nearestToEdge(vec3 foot, vec3 direction, float low, float high,
                                       vec3 corner, vec3 edge) {
    vec3 apart = foot - corner;
    float ahead = dot(direction, apart);
    float along = dot(edge, apart);
    float slant = dot(direction, edge);
    float square = dot(edge, edge);
    float determinant = square - slant * slant;
    float share = determinant > 1e-6f * square ? (along - slant * ahead) / determinant : 0.5f;
    float u = clamp(slant * clamp(share, 0.0f, 1.0f) - ahead, low, high);
    share = clamp((along + slant * u) / square, 0.0f, 1.0f);
    return clamp(slant * share - ahead, low, high);
}

NIGHTCITY_FUNCTION vec2 inOrder(vec2 pair) {
    return vec2(min(pair.x, pair.y), max(pair.x, pair.y));
}

// u of the four cuts, rising.
NIGHTCITY_FUNCTION vec4 paneEdgeCuts(AirlightInterval i, PaneFrame pane) {
    vec3 w = pane.direction;
    vec3 low = vec3(-pane.a, -pane.b, 0.0f);
    vec3 high = vec3(pane.a, pane.b, 0.0f);
    vec3 x = vec3(2.0f * pane.a, 0.0f, 0.0f);
    vec3 y = vec3(0.0f, 2.0f * pane.b, 0.0f);
    vec2 p = inOrder(vec2(nearestToEdge(i.foot, w, i.ua, i.ub, low, x),
                          nearestToEdge(i.foot, w, i.ua, i.ub, high, -x)));
    vec2 q = inOrder(vec2(nearestToEdge(i.foot, w, i.ua, i.ub, low, y),
                          nearestToEdge(i.foot, w, i.ua, i.ub, high, -y)));
    vec2 outer = vec2(min(p.x, q.x), max(p.y, q.y));
    vec2 inner = inOrder(vec2(max(p.x, q.x), min(p.y, q.y)));
    return vec4(outer.x, inner.x, inner.y, outer.y);
}

// The interval as if the ray passed the centre of a pane of `area` m^2 at least at half a side.
NIGHTCITY_FUNCTION AirlightInterval airlightWide(AirlightInterval i, float area) {
    AirlightInterval wide = i;
    wide.h = sqrt(i.h * i.h + 0.33f * area);
    wide.da = sqrt(wide.h * wide.h + i.ua * i.ua);
    wide.db = sqrt(wide.h * wide.h + i.ub * i.ub);
    return wide;
}

// One piece between two cuts, for `count` nodes: the tangent substitution about the
// centre in the wide interval.
NIGHTCITY_FUNCTION float airlightPanePiece(AirlightInterval i, PaneFrame pane, float extinction,
                                           int count) {
    float area = 4.0f * pane.a * pane.b;
    AirlightInterval wide = airlightWide(i, area);
    float arc = airlightArc(wide);
    float sum = 0.0f;
    for (int index = 0; index < count; ++index) {
        vec2 node = gaussNode(count, index);
        // x^2 (3 - 2 x): crowded at both ends
        float share = node.x * node.x * (3.0f - 2.0f * node.x);
        float weight = 6.0f * node.x * (1.0f - node.x) * node.y;
        float step = airlightStepOfArc(wide, arc, share);
        float d = airlightDistance(wide, step);
        vec3 point = i.foot + (i.ua + step) * pane.direction;
        point.z = max(point.z, kPaneNearest);
        float angle = paneSolidAngle(point, pane.a, pane.b);
        float mean = paneMeanDistance(area, point.z, angle);
        sum += weight * d * d * angle * airlightAttenuation(i, extinction, step, mean);
    }
    return sum * arc / (wide.h * area);
}

// Nodes of a piece across which the light falls by exp(-depth).
NIGHTCITY_FUNCTION int paneNearNodes(float depth, float tolerance) {
    float need = 2.0f - 0.9031f * log2(tolerance) + 0.5f * depth;
    return int(clamp(ceil(need), 3.0f, float(kGaussMost)));
}

// An interval on the bright side of the pane.
NIGHTCITY_FUNCTION float airlightPaneNear(AirlightInterval interval, PaneFrame pane,
                                          float extinction, float tolerance) {
    AirlightInterval i = airlightClipped(interval, extinction,
                                         airlightClipDepth(tolerance, kAirlightLambertian));
    vec4 cuts = paneEdgeCuts(i, pane);
    float shortest = 1e-4f * (pane.a + pane.b);
    float low = i.ua;
    float sum = 0.0f;
    for (int k = 0; k < 5; ++k) {
        float high = k < 4 ? cuts[k] : i.ub;
        if (k < 4 && (high - low < shortest || i.ub - high < shortest)) {
            continue;  // no piece of its own
        }
        AirlightInterval piece = airlightPart(i, low, high);
        float depth = extinction * airlightDetour(piece, piece.span, piece.db);
        sum += airlightPanePiece(piece, pane, extinction, paneNearNodes(depth, tolerance));
        low = high;
    }
    return sum;
}

NIGHTCITY_END

#endif
