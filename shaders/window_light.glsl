// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What one window adds to the glow of a part of a stretch that all of it, or a piece of its
// pane, sees: in 1/m, the fluence of 1 W times 4 pi / 4, integrated with the attenuation from
// the stretch's begin. Times scattering / (4 pi) / pi it is radiance.
#ifndef NIGHTCITY_SHADERS_WINDOW_LIGHT_GLSL
#define NIGHTCITY_SHADERS_WINDOW_LIGHT_GLSL

#include "pane.glsl"
#include "source_depth.glsl"
#include "transport/airlight_pane.h"
#include "visible_parts.glsl"

layout(constant_id = NIGHTCITY_CONSTANT_EMITTER) const uint kEmitter = kEmitterIsotropic;

// A window, or a piece of its pane, about view.anchor + view.offset.
struct Emitter {
    vec3 halfU;     // m
    vec3 halfV;
    vec3 normal;    // unit vector, to the bright side
    uint kind;      // kEmitterIsotropic and so on
    float nearest;  // m, radius of a sphere, inside which there is no haze; else 0
};

uint kindOf(Window window) {
    return (window.flags & kWindowSphere) != 0u ? kEmitterIsotropic : kEmitter;
}

const float kMostPanePieces = 16.0;  // along each side of a pane that is seen in part
const float kPaneShare = 0.5;        // of the tolerance, which such pieces may be off by
// Optical depth where quadrature is no longer cut into more pieces.
const float kDepthOfPiece = 2.0;
const float kMostDepthPieces = 8.0;
// Light that goes 10 km through clear air to thin haze: exp(-excess) alone would overflow.
const float kMostExcess = 20.0;

float windowTolerance() {
    return max(0.5 * frameTable.tolerance, 1e-4);
}

// In haze of one kind.
float inUniformHaze(Emitter emitter, PointView view, AirlightInterval part, float extinction) {
    if (emitter.kind == kEmitterIsotropic) {
        return 0.25 * airlightIsotropic(part, extinction, windowTolerance());
    }
    if (emitter.kind == kEmitterLambertian) {
        return airlightLambertian(part, view.along, emitter.normal, extinction,
                                  windowTolerance());
    }
    vec3 fromCentre = view.interval.foot + view.interval.ua * view.along;
    return airlightPane(fromCentre, view.along, emitter.halfU, emitter.halfV, part.begin,
                        part.begin + part.span, extinction, max(windowTolerance(), 1e-3));
}

// cos, of a pane the mean of cos / d^2 times d^2, towards `way`.
float lobeAt(Emitter emitter, vec3 way, float d) {
    if (emitter.kind == kEmitterIsotropic) {
        return 0.25;
    }
    float height = dot(way, emitter.normal);
    if (emitter.kind == kEmitterLambertian || height <= 0.0) {
        return max(height, 0.0) / d;
    }
    float a = length(emitter.halfU);
    float b = length(emitter.halfV);
    vec3 point = vec3(dot(way, emitter.halfU) / a, dot(way, emitter.halfV) / b,
                      max(height, kPaneNearest));
    return paneSolidAngle(point, a, b) * d * d / (4.0 * a * b);
}

// Nodes of one piece for haze whose depth changes by so much over it.
int mixedNodes(Emitter emitter, AirlightInterval part, float change) {
    float digits = -0.30103 * log2(windowTolerance());
    int count = int(clamp(ceil(0.5 + digits + 4.0 * change), 2.0, 8.0));
    if (emitter.kind == kEmitterPane) {
        float sides = paneSides(part, length(emitter.halfU), length(emitter.halfV));
        count = max(count, paneFarNodes(max(sides, 1.0), windowTolerance()));
    }
    return count;
}

// Nodes in the angle under which the emitter sees the part, in pieces over which the depth
// changes by little: for haze of several kinds, whose depth bends where the way crosses
// from one into the other. Three nodes before those measure that change, and `excess`, what
// light by way of the middle meets besides haze as about the ray; where that is the same by
// way of the ends, or `isNear`, they are all, and the result is negative.
float inMixedHaze(Emitter emitter, PointView view, AirlightInterval part, float extinction,
                  bool isNear, out float excess) {
    excess = 0.0;
    vec2 excesses = vec2(1e30, -1e30);  // least and most
    float arc = airlightArc(part);
    float pieces = 1.0;
    float change = 0.0;
    float last = 0.0;
    float sum = 0.0;
    int count = 1;
    for (int k = 0; k < 3 + int(pieces) * count; ++k) {
        int piece = (k - 3) / count;
        vec2 node = gaussNode(count, max(k - 3 - piece * count, 0));
        float share = k < 3 ? 0.5 * float(k) : (float(piece) + node.x) / pieces;
        float step = airlightStepOfArc(part, arc, share);
        vec3 way = view.interval.foot + (part.ua + step) * view.along;
        float d = airlightDistance(part, step);
        float toSource = sourceDepth(view.anchor, view.offset, way);
        float depth = extinction * (part.begin + step) + toSource;
        if (k < 3) {
            change += k > 0 ? abs(depth - last) : 0.0;
            last = depth;
            float here = toSource - extinction * d;
            excess = k == 1 ? here : excess;
            excesses = vec2(min(excesses.x, here), max(excesses.y, here));
            bool isSame = excesses.y - excesses.x < 0.1 * windowTolerance() &&
                          abs(excess) < kMostExcess;
            if (k == 2 && (isNear || isSame)) {
                return -1.0;
            }
            pieces = clamp(ceil(change / kDepthOfPiece), 1.0, kMostDepthPieces);
            count = k == 2 ? mixedNodes(emitter, part, change / pieces) : 1;
        } else {
            sum += node.y * lobeAt(emitter, way, d) * exp(-depth);
        }
    }
    return sum * arc / (part.h * pieces);
}

// Close to a pane its solid angle changes too fast for inMixedHaze, and the light's way is
// short: there the haze is taken as about the ray, corrected by the middle's way.
float overHaze(Emitter emitter, PointView view, AirlightInterval part, float extinction) {
    if (emitter.kind != kEmitterIsotropic) {
        part = airlightBrightPart(part, airlightLobe(part, view.along, emitter.normal));
    }
    if (part.span <= 0.0) {
        return 0.0;
    }
    float excess = 0.0;
    if (!kHazeIsUniform) {
        bool isNear = emitter.kind == kEmitterPane &&
                      paneSides(part, length(emitter.halfU), length(emitter.halfV)) < 1.0;
        float sum = inMixedHaze(emitter, view, part, extinction, isNear, excess);
        if (sum >= 0.0) {
            return sum;
        }
    }
    return inUniformHaze(emitter, view, part, extinction) * exp(-excess);
}

// `range`: t of begin and end. A sphere's own inside is left out.
float overPart(Emitter emitter, PointView view, vec2 range, float extinction) {
    AirlightInterval i = view.interval;
    vec2 u = range + i.ua;
    float inside = sqrt(max(emitter.nearest * emitter.nearest - i.h * i.h, 0.0));
    float sum = 0.0;
    for (int side = 0; side < (inside > 0.0 ? 2 : 1); ++side) {
        float low = side == 0 ? u.x : max(u.x, inside);
        float high = side == 0 && inside > 0.0 ? min(u.y, -inside) : u.y;
        sum += overHaze(emitter, view, airlightPart(i, low, max(low, high)), extinction);
    }
    return sum;
}

#endif
