// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Single scattering along a ray: the baked far part sampled between the media's borders,
// and the near part of each window around.
#ifndef NIGHTCITY_SHADERS_GLOW_ALONG_RAY_GLSL
#define NIGHTCITY_SHADERS_GLOW_ALONG_RAY_GLSL

#include "haze_runs.glsl"
#include "near_field.glsl"
#include "transport/constants.glsl"

// Node spacings of the far field a pair of Gauss nodes. Of isotropic windows the edges of shadows
// lie amid the bricks (passes/far_alignment.h).
const float kFarStretch = 4.0;
const float kFarStretchOfIsotropic = 2.0;
// m: media nearer to each other along a ray have no gap between them.
const float kMediaGap = 1e-3;
// m, and as a share of the way: no haze is so thin, but a ray onto a roof or a wall that ends
// where the haze does meets as much by rounding.
const float kThinnest = 1e-4;
const float kThinnestShare = 1e-6;

// As runError has them: shares of the light and of the nodes' estimates, and of near panes in
// tolerances. Chosen so that 99 of 100 pixels of paper-4x4 lie within (docs/accuracy.md).
const float kErrorInCommon = 0.8e-3;
const float kErrorOfFar = 1.25;
const float kErrorOfNear = 0.25;

// A part of a ray in haze of one kind, and in bricks that all hold the near parts or do not.
struct HazeRun {
    float begin, end;  // m
    bool isBlurred;
    float extinction, scattering;  // 1/m
    vec3 far;          // W m^-1: Int far fluence exp(-extinction (t - begin)) dt
    // Where kLedger:
    float farSquares;  // (W m^-1)^2, of its estimated errors, stretch by stretch
    float farSamples;  // how many were taken
};

// Adds [begin, end] of the ray, in one medium, to a run, or as much as lies in bricks like those
// before. Brick by brick: inside one the field is smooth, so that one Gauss rule serves for all
// of it, two nodes at a time.
void addFar(FarFieldTable field, FieldRay ray, float begin, float end, inout HazeRun run) {
    BrickStep brick;
    vec3 start = vec3(0.0), pace = vec3(0.0);
    float stop = begin;  // m, in the brick
    float span = 0.0;
    int count = 0;  // nodes in the brick, even
    int pair = 0;   // of them
    while (begin < end) {
        if (pair == 0) {
            brick = brickAfter(field, ray, begin);
            if (run.end > run.begin && brick.isBlurred != run.isBlurred) {
                break;
            }
            run.isBlurred = brick.isBlurred;
            stop = min(brick.end, end);
            span = stop - begin;
            float spacing = field.cellSide * brick.side / float(kBrickSteps);
            float most =
                kNearEmitter == kEmitterIsotropic ? kFarStretchOfIsotropic : kFarStretch;
            count = 2 * int(clamp(ceil(span / (most * spacing) - 0.01), 1.0,
                                  0.5 * float(kGaussMost)));
            start = (ray.start - brick.corner) / brick.side;
            pace = ray.pace / brick.side;
        }
        vec2 node = gaussNode(count, pair);
        vec4 sum = vec4(0.0);
        if (brick.index != kNone) {
            for (int k = 0; k < 2; ++k) {
                float t = begin + (k == 0 ? node.x : 1.0 - node.x) * span;
                sum += farSample(field, brick.index, start + t * pace) *
                       exp(run.extinction * (run.begin - t));
            }
        }
        run.far += node.y * span * sum.rgb;
        if (kLedger) {
            float error = node.y * span * sum.a;
            run.farSquares += error * error;
            run.farSamples += brick.index != kNone ? 2.0 : 0.0;
        }
        ++pair;
        if (2 * pair == count) {
            pair = 0;
            run.end = stop;
            begin = max(brick.end, stop);
        }
    }
}

// The next run of a walk, which goes on to where it ends. False: there is none.
bool nextRun(FarFieldTable field, FieldRay ray, inout HazeWalk walk, out HazeRun run) {
    MediumPiece piece = nextMedium(walk);
    run = HazeRun(piece.begin, piece.begin, false, piece.extinction, piece.scattering, vec3(0.0),
                  0.0, 0.0);
    if (piece.begin >= walk.end) {
        return false;
    }
    HazeWalk ended = walk;
    while (piece.begin <= run.end + kMediaGap && piece.begin < walk.end &&
           piece.extinction == run.extinction && piece.scattering == run.scattering) {
        addFar(field, ray, piece.begin, piece.end, run);
        ended = walk;
        if (run.end < piece.end) {
            ended.at = run.end;
            break;
        }
        piece = nextMedium(walk);
    }
    walk = ended;
    return true;
}

float brightest(vec3 light) {
    return max(light.r, max(light.g, light.b));
}

// Estimated errors of a run, W m^-1. Those of stretches a node spacing or two apart are taken as
// independent, but for a share of all far light that they have in common, as light from panes
// seen by quarters has.
float runError(HazeRun run, vec3 near, float tolerance) {
    float shared_ = kErrorInCommon * brightest(run.far);
    float quadrature = kErrorOfNear * tolerance * brightest(near);
    return shared_ + sqrt(kErrorOfFar * kErrorOfFar * run.farSquares + quadrature * quadrature);
}

// Of a ray of the tile with a unit direction, up to `end` m. `ledger` is kept where kLedger.
GlowSample glowAlongRay(Ray ray, float end, uint tile, GlowTable table, out GlowLedger ledger) {
    ledger = GlowLedger(0.0, 0.0);
    GlowSample result = GlowSample(vec3(0.0), 0.0);
    FarFieldTable field = farFieldTable;
    if (field.cellCounts.x == 0u) {
        return result;
    }
    FieldRay inField = fieldRay(field, ray);
    vec3 high = field.origin + field.cellSide * vec3(field.cellCounts);
    float at, last;
    boxInterval(ray.origin, ray.direction, inField.inverse, field.origin, high, end, at, last);
    float radius = nearTable.radius;
    HazeWalk walk = hazeWalk(ray, last);
    walk.at = at;
    HazeRun run;
    while (nextRun(field, inField, walk, run)) {
        if (run.end - run.begin < kThinnest + kThinnestShare * run.end) {
            continue;
        }
        Ray onward = Ray(ray.origin + run.begin * ray.direction, ray.direction);
        NearPiece piece = NearPiece(onward, run.end - run.begin, run.extinction, radius,
                                    table.tolerance);
        NearSum near = NearSum(vec3(0.0), 0.0);
        if (!run.isBlurred) {
            near = nearGlow(piece, tile, table);
        }
        float share = kInverse4Pi * run.scattering * exp(-result.depth);
        result.glow += share * (run.far + near.light);
        if (kLedger) {
            ledger.error += share * runError(run, near.light, table.tolerance);
            ledger.cost += run.farSamples + near.nodes;
        }
        result.depth += run.extinction * (run.end - run.begin);
    }
    return result;
}

#endif
