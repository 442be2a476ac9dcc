// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// A ray through the lattice of the far field (far_field.glsl), brick by brick, and through the
// media that the bricks list.
#ifndef NIGHTCITY_SHADERS_HAZE_RUNS_GLSL
#define NIGHTCITY_SHADERS_HAZE_RUNS_GLSL

#include "box_interval.glsl"
#include "camera_ray.glsl"
#include "far_field.glsl"

// A ray with a unit direction in the lattice of the far field.
struct FieldRay {
    vec3 origin;     // m
    vec3 direction;
    vec3 inverse;    // reciprocal(direction)
    vec3 start;      // the origin, in cells from the lattice's corner
    vec3 pace;       // cells a metre
};

// The brick that a ray is in, or the cell where no brick is.
struct BrickStep {
    uint index;   // into the bricks; kNone: no haze
    vec3 corner;  // in cells from the lattice's corner
    float side;   // cells
    float end;    // m along the ray, where it leaves it: always further on
};

// The haze that a ray meets next.
struct MediumPiece {
    float begin, end;  // m; begin >= end: none
    float extinction, scattering;  // 1/m
};

FieldRay fieldRay(FarFieldTable field, Ray ray) {
    FieldRay inCells;
    inCells.origin = ray.origin;
    inCells.direction = ray.direction;
    inCells.inverse = reciprocal(ray.direction);
    inCells.start = (ray.origin - field.origin) / field.cellSide;
    inCells.pace = ray.direction / field.cellSide;
    return inCells;
}

// m: past what a float loses of a place so far along the ray, and nothing to a cell's side.
float nudge(FarFieldTable field, float at) {
    return 1e-4 * field.cellSide + 1e-6 * at;
}

// Just after `at`, in the lattice.
BrickStep brickAfter(FarFieldTable field, FieldRay ray, float at) {
    float inside = at + nudge(field, at);
    vec3 place = ray.start + inside * ray.pace;
    ivec3 cell = clamp(ivec3(floor(place)), ivec3(0), ivec3(field.cellCounts) - 1);
    uint word = indexAt(field, cell);
    uint scale = word == kNone ? 0u : word >> kScaleShift;
    BrickStep brick;
    brick.index = brickOfIndex(word);
    brick.corner = vec3(cell >> scale << scale);
    brick.side = float(1u << scale);
    vec3 far = brick.corner + mix(vec3(0.0), vec3(brick.side), greaterThan(ray.pace, vec3(0.0)));
    vec3 way = mix((far - ray.start) * field.cellSide * ray.inverse, vec3(1e30),
                   lessThan(abs(ray.direction), vec3(kSmallestDirection)));
    brick.end = max(inside, min(way.x, min(way.y, way.z)));
    return brick;
}

// The first medium of a brick's list that the ray is in from `from` on, up to `to`.
MediumPiece mediumFrom(FarFieldTable field, uint index, FieldRay ray, float from, float to) {
    MediumPiece piece = MediumPiece(to, to, 0.0, 0.0);
    FarBrick brick = FarBrickArray(field.bricks).at[index];
    for (uint i = 0u; i < brick.mediumCount; ++i) {
        uint listed = UintArray(field.mediumList).at[brick.firstMedium + i];
        FarMedium medium = FarMediumArray(field.media).at[listed];
        float entry, exit;
        boxInterval(ray.origin, ray.direction, ray.inverse, medium.lo, medium.hi, to, entry, exit);
        entry = max(entry, from);
        if (exit - entry > 1e-5 * (1.0 + exit) && entry < piece.begin) {
            piece = MediumPiece(entry, exit, medium.extinction, medium.scattering);
        }
    }
    return piece;
}

// The next piece from `at` on, before `end`: all of the ray's way through one medium.
MediumPiece nextMedium(FarFieldTable field, FieldRay ray, float at, float end) {
    while (at < end) {
        BrickStep brick = brickAfter(field, ray, at);
        if (brick.index != kNone) {
            // What begins after the brick may not be the first there.
            MediumPiece piece = mediumFrom(field, brick.index, ray, at, end);
            if (piece.begin < min(brick.end, end)) {
                return piece;
            }
        }
        at = brick.end;
    }
    return MediumPiece(end, end, 0.0, 0.0);
}

#endif
