// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The near part of a pane's fluence (near_far_split.h), integrated along a ray:
//
//   Int omega(x(t)) nearShare(d^2 / R^2) exp(-tau (t + mean distance to the pane)) dt    (m sr)
//
// over the part of the ray within R of the pane's centre and in front of it. Times the
// pane's radiance P / (pi A) this is the integral of the near fluence. A window that is a point
// of light has lobe / d^2 in the place of omega and its intensity in that of the radiance.
// Binding-free.
//
// The nodes lie evenly in the angle under which the pane sees the ray, as if the ray passed
// it at least at half a side (airlight_pane_near.h). How many are needed depends on how near
// the ray comes, in sides: past one side four are within 1 % (99 of 100 random rays);
// below a third of a side eight are, where it does not graze the pane; else it is cut at its
// nearest points to the pane's edges.
#ifndef NIGHTCITY_TRANSPORT_NEAR_WINDOW_H
#define NIGHTCITY_TRANSPORT_NEAR_WINDOW_H

#include "airlight_pane_near.h"
#include "near_far_split.h"

NIGHTCITY_BEGIN

// Of a piece of a ray past a point of light, that are within 0.5 % (99 of 100 random rays).
NIGHTCITY_CONST float kNodesOfPoint = 8.0f;
// Sides from the pane within which a ray is cut at the pane's edges.
NIGHTCITY_CONST float kNearCutSides = 0.3f;
// Nodes of each piece between such cuts that are within 1 %.
NIGHTCITY_CONST float kNodesOfPiece = 5.0f;
// Sine of the angle to the pane from which on that is not needed for 1 %: eight nodes are off
// by 2 % then at p99 of the rays so close, and by 40 % along the pane.
NIGHTCITY_CONST float kNearGrazing = 0.4f;

// The part of [begin, end] of the ray within `radius` of the origin, as (begin, end); empty where
// end <= begin. `foot` is the nearest point of the ray, `delta` m along it.
NIGHTCITY_FUNCTION vec2 ballChord(vec3 foot, float delta, float radius, float begin, float end) {
    float reach2 = radius * radius - dot(foot, foot);
    if (reach2 <= 0.0f) {
        return vec2(0.0f, 0.0f);
    }
    float reach = sqrt(reach2);
    return vec2(max(begin, delta - reach), min(end, delta + reach));
}

// The same about a window's centre, and nowhere farther than `back` m behind its plane.
NIGHTCITY_FUNCTION vec2 nearChord(PaneFrame pane, float back, float radius, float begin,
                                  float end) {
    float delta = -dot(pane.origin, pane.direction);
    vec3 foot = pane.origin + delta * pane.direction;
    vec2 chord = ballChord(foot, delta, radius, begin, end);
    float speed = pane.direction.z;
    float height = foot.z + back;
    float crossing = delta - height / (abs(speed) > 1e-12f ? speed : 1e-12f);
    if (speed > 0.0f) {
        chord.x = max(chord.x, crossing);
    } else if (speed < 0.0f) {
        chord.y = min(chord.y, crossing);
    } else if (height <= 0.0f) {
        chord.y = chord.x;
    }
    return chord;
}

// Sides (root of the area) from the pane to the point of an interval nearest its centre.
NIGHTCITY_FUNCTION float nearSides(AirlightInterval i, PaneFrame pane) {
    vec3 nearest = i.foot + clamp(0.0f, i.ua, i.ub) * pane.direction;
    vec3 beyond = max(abs(nearest) - vec3(pane.a, pane.b, 0.0f), vec3(0.0f, 0.0f, 0.0f));
    return 0.5f * sqrt(dot(beyond, beyond) / (pane.a * pane.b));
}

// Of what is enough for 1 %, for a relative tolerance of 1e-4 to 0.1 of the whole pane's light:
// half as many nodes again for each decimal.
NIGHTCITY_FUNCTION int nodesFor(float atPercent, float tolerance) {
    float decimals = -0.30103f * log2(100.0f * tolerance);
    return int(clamp(ceil(atPercent * (1.0f + 0.5f * decimals) - 0.01f), 2.0f, float(kGaussMost)));
}

// Of an interval at so many sides.
NIGHTCITY_FUNCTION float nearNodes(float sides) {
    return sides > 1.75f   ? 3.0f
           : sides > 0.75f ? 4.0f
           : sides > 0.55f ? 5.0f
           : sides > 0.4f  ? 6.0f
                           : 8.0f;
}

// One piece of an interval; interval.begin counts from where the attenuation does. thinHaze:
// light from the pane is attenuated as from its centre, which is nearer or farther than the
// mean by at most half a diagonal.
NIGHTCITY_FUNCTION float nearPiece(AirlightInterval i, PaneFrame pane, float radius,
                                   float extinction, bool thinHaze, int count) {
    float area = 4.0f * pane.a * pane.b;
    AirlightInterval wide = airlightWide(i, area);
    float arc = airlightArc(wide);
    float sum = 0.0f;
    for (int index = 0; index < count; ++index) {
        vec2 node = gaussNode(count, index);
        float step = airlightStepOfArc(wide, arc, node.x);
        float u = i.ua + step;
        float d2 = i.h * i.h + u * u;
        vec3 point = i.foot + u * pane.direction;
        point.z = max(point.z, kPaneNearest);
        float angle = paneSolidAngle(point, pane.a, pane.b);
        float mean = thinHaze ? sqrt(d2) : paneMeanDistance(area, point.z, angle);
        float light = angle * nearShare(d2 / (radius * radius)) *
                      airlightAttenuation(i, extinction, step, mean);
        sum += node.y * (wide.h * wide.h + u * u) * light;
    }
    return sum * arc / wide.h;
}

// The ray passes within kNearCutSides: pieces between its nearest points to the edges.
NIGHTCITY_FUNCTION float nearPieces(AirlightInterval i, PaneFrame pane, float radius,
                                    float extinction, int count) {
    vec4 cuts = paneEdgeCuts(i, pane);
    float shortest = 1e-4f * (pane.a + pane.b);
    float low = i.ua;
    float sum = 0.0f;
    for (int k = 0; k < 5; ++k) {
        float high = k < 4 ? cuts[k] : i.ub;
        if (k < 4 && (high - low < shortest || i.ub - high < shortest)) {
            continue;  // no piece of its own
        }
        sum += nearPiece(airlightPart(i, low, high), pane, radius, extinction, false, count);
        low = high;
    }
    return sum;
}

// What a pane's near part is along a piece of a ray, up to how it is integrated.
struct NearPass {
    AirlightInterval interval;  // about the pane's centre; `begin` from where attenuation counts
    float sides;                // nearSides
};

// chord: of nearChord; attenuation along the ray counts from `begin` (m).
NIGHTCITY_FUNCTION NearPass nearPass(PaneFrame pane, vec2 chord, float begin) {
    NearPass pass;
    pass.interval = airlightInterval(pane.origin, pane.direction, chord.x, chord.y);
    pass.interval.begin -= begin;
    pass.sides = nearSides(pass.interval, pane);
    return pass;
}

// Whether the integral is to be taken in pieces; `always`: also of rays that do not graze.
NIGHTCITY_FUNCTION bool isNearCut(NearPass pass, PaneFrame pane, bool always) {
    return pass.sides <= kNearCutSides && (always || abs(pane.direction.z) < kNearGrazing);
}

// How many nodes its integral takes, in pieces at most.
NIGHTCITY_FUNCTION float nodesOfPass(NearPass pass, bool inPieces, float tolerance) {
    return inPieces ? 5.0f * float(nodesFor(kNodesOfPiece, tolerance))
                    : float(nodesFor(nearNodes(pass.sides), tolerance));
}

// The integral in one piece. extinction in 1/m, 0 to 10; tolerance as in
// nodesFor; thinHaze as in nearPiece.
NIGHTCITY_FUNCTION float nearBeside(NearPass pass, PaneFrame pane, float radius, float extinction,
                                    float tolerance, bool thinHaze) {
    return nearPiece(pass.interval, pane, radius, extinction, thinHaze,
                     nodesFor(nearNodes(pass.sides), tolerance));
}

// The same in pieces.
NIGHTCITY_FUNCTION float nearAtEdges(NearPass pass, PaneFrame pane, float radius, float extinction,
                                     float tolerance) {
    return nearPieces(pass.interval, pane, radius, extinction, nodesFor(kNodesOfPiece, tolerance));
}

// Int lobe nearShare(d^2 / R^2) exp(-tau (t + d)) / d^2 dt (1/m) of a point of light, about which
// the interval is: its near fluence for an intensity of 1 W/sr. The lobe is 1, or of a cosine
// emitter the cosine to the z axis of the pane. The nodes lie evenly in the angle.
NIGHTCITY_FUNCTION float nearPointPiece(AirlightInterval i, PaneFrame pane, bool hasLobe,
                                        float radius, float extinction, int count) {
    float arc = airlightArc(i);
    float sum = 0.0f;
    for (int index = 0; index < count; ++index) {
        vec2 node = gaussNode(count, index);
        float step = airlightStepOfArc(i, arc, node.x);
        float d = airlightDistance(i, step);
        float light = nearShare(d * d / (radius * radius)) *
                      airlightAttenuation(i, extinction, step, d);
        if (hasLobe) {
            light *= max(i.foot.z + (i.ua + step) * pane.direction.z, 0.0f) / d;
        }
        sum += node.y * light;
    }
    return sum * arc / i.h;
}

// How many nodes a piece past a point takes; tolerance as in nodesFor.
NIGHTCITY_FUNCTION int nodesOfPoint(float tolerance) {
    return nodesFor(kNodesOfPoint, min(tolerance, 0.01f));
}

// The ray about the point of light; chord: of nearChord, not empty; attenuation counts from `begin`.
// `size`: m, of a sphere of light, whose inside is left out; 0 of a point.
NIGHTCITY_FUNCTION float nearPoint(PaneFrame pane, bool hasLobe, float size, float radius,
                                   vec2 chord, float begin, float extinction, float tolerance) {
    int count = nodesOfPoint(tolerance);
    AirlightInterval i = airlightInterval(pane.origin, pane.direction, chord.x, chord.y);
    i.begin -= begin;
    if (i.h >= size) {
        return nearPointPiece(i, pane, hasLobe, radius, extinction, count);
    }
    float inside = sqrt(size * size - i.h * i.h);
    float sum = 0.0f;
    if (i.ua < -inside) {
        sum += nearPointPiece(airlightPart(i, i.ua, min(i.ub, -inside)), pane, hasLobe, radius,
                              extinction, count);
    }
    if (i.ub > inside) {
        sum += nearPointPiece(airlightPart(i, max(i.ua, inside), i.ub), pane, hasLobe, radius,
                              extinction, count);
    }
    return sum;
}

NIGHTCITY_END

#endif
