// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Single scattering along a ray: the baked far part sampled between the media's borders,
// and the near part of each window around.
#ifndef NIGHTCITY_SHADERS_GLOW_ALONG_RAY_GLSL
#define NIGHTCITY_SHADERS_GLOW_ALONG_RAY_GLSL

#include "far_field.glsl"
#include "near_field.glsl"
#include "transport/constants.glsl"

// Node spacings of the far field under two Gauss nodes.
const float kFarStretch = 2.0;
const float kGaussOfTwo = 0.211324865;  // the first node of two on (0, 1)
// m: media nearer to each other along a ray have no gap between them.
const float kMediaGap = 1e-3;

// The haze that a ray meets next, from a distance on.
struct MediumPiece {
    float begin, end;  // m; begin >= end: none
    float extinction, scattering;  // 1/m
};

// A part of a ray in haze of one kind.
struct HazeRun {
    float begin, end;  // m
    float extinction, scattering;  // 1/m
    vec3 far;          // W m^-1: Int far fluence exp(-extinction (t - begin)) dt
};

// Within [from, to] of the ray, which lies in the brick.
MediumPiece mediumFrom(FarFieldTable field, FarBrick brick, Ray ray, vec3 inverse, float from,
                       float to) {
    MediumPiece piece = MediumPiece(to, to, 0.0, 0.0);
    for (uint i = 0u; i < brick.mediumCount; ++i) {
        uint index = UintArray(field.mediumList).at[brick.firstMedium + i];
        FarMedium medium = FarMediumArray(field.media).at[index];
        float entry, exit;
        boxInterval(ray.origin, ray.direction, inverse, medium.lo, medium.hi, to, entry, exit);
        entry = max(entry, from);
        if (exit - entry > 1e-5 * (1.0 + exit) && entry < piece.begin) {
            piece = MediumPiece(entry, exit, medium.extinction, medium.scattering);
        }
    }
    return piece;
}

vec3 farOnPiece(FarFieldTable field, uint index, FarBrick brick, Ray ray, MediumPiece piece,
                float runBegin) {
    float side = brickSide(field, brick);
    float spacing = brickSpacing(field, brick);
    float span = piece.end - piece.begin;
    float stretches = max(ceil(span / (kFarStretch * spacing)), 1.0);
    float stretch = span / stretches;
    vec3 origin = (ray.origin - brickCorner(field, brick)) / side;
    vec3 direction = ray.direction / side;
    vec3 sum = vec3(0.0);
    for (float k = 0.0; k < 2.0 * stretches; k += 1.0) {
        float pair = floor(0.5 * k);
        float node = k == 2.0 * pair ? kGaussOfTwo : 1.0 - kGaussOfTwo;
        float t = piece.begin + (pair + node) * stretch;
        sum += farFluence(field, index, origin + t * direction) *
               exp(piece.extinction * (runBegin - t));
    }
    return 0.5 * stretch * sum;
}

// Steps out of the brick, and returns where the ray leaves it, m.
float leaveBrick(FarBrick brick, inout LatticeWalk walk) {
    float exit;
    do {
        exit = cellExit(walk);
        stepOn(walk);
    } while (isInBrick(walk.cell, brick));
    return exit;
}

// The next run from `at` on; `walk` and `at` go on to where it ends. False where there is none
// before `end`.
bool nextRun(FarFieldTable field, Lattice lattice, Ray ray, vec3 inverse, float end,
             inout LatticeWalk walk, inout float at, out HazeRun run) {
    run = HazeRun(0.0, 0.0, 0.0, 0.0, vec3(0.0));
    bool found = false;
    while (at < end && insideLattice(walk, lattice)) {
        LatticeWalk onward = walk;
        float exit;
        uint index = UintArray(field.index).at[latticeCell(walk, lattice)];
        if (index == kNone) {
            if (found) {
                return true;
            }
            exit = min(cellExit(walk), end);
            stepOn(onward);
        } else {
            FarBrick brick = FarBrickArray(field.bricks).at[index];
            exit = min(leaveBrick(brick, onward), end);
            while (at < exit) {
                MediumPiece piece = mediumFrom(field, brick, ray, inverse, at, exit);
                bool none = piece.begin >= exit;
                if (found && (piece.begin > at + kMediaGap ||
                              (!none && (piece.extinction != run.extinction ||
                                         piece.scattering != run.scattering)))) {
                    return true;
                }
                if (none) {
                    break;
                }
                if (!found) {
                    found = true;
                    run.begin = piece.begin;
                    run.extinction = piece.extinction;
                    run.scattering = piece.scattering;
                }
                run.far += farOnPiece(field, index, brick, ray, piece, run.begin);
                run.end = piece.end;
                at = piece.end;
            }
        }
        at = exit;
        walk = onward;
    }
    return found;
}

// Of a ray with a unit direction, up to `end` m. `tolerance` is relative, of the near parts.
GlowSample glowAlongRay(Ray ray, float end, float tolerance) {
    GlowSample result = GlowSample(vec3(0.0), 0.0);
    FarFieldTable field = farFieldTable;
    if (field.cellCounts.x == 0u) {
        return result;
    }
    vec3 inverse = reciprocal(ray.direction);
    vec3 high = field.origin + field.cellSide * vec3(field.cellCounts);
    float at, last;
    boxInterval(ray.origin, ray.direction, inverse, field.origin, high, end, at, last);
    if (at >= last) {
        return result;
    }
    Lattice lattice = Lattice(field.origin, field.cellSide, ivec3(field.cellCounts));
    LatticeWalk walk = latticeWalk(ray, inverse, at, lattice);
    HazeRun run;
    while (nextRun(field, lattice, ray, inverse, last, walk, at, run)) {
        vec3 fluence = run.far + nearGlow(ray, inverse, run.begin, run.end, run.extinction,
                                          tolerance);
        result.glow += kInverse4Pi * run.scattering * exp(-result.depth) * fluence;
        result.depth += run.extinction * (run.end - run.begin);
    }
    return result;
}

#endif
