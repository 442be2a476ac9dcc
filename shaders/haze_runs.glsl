// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// A ray through the lattice of the far field (far_field.glsl), brick by brick, and through the
// haze (haze_walk.glsl), whose tree stays small where a brick far away holds hundreds of media.
#ifndef NIGHTCITY_SHADERS_HAZE_RUNS_GLSL
#define NIGHTCITY_SHADERS_HAZE_RUNS_GLSL

#include "box_interval.glsl"
#include "camera_ray.glsl"
#include "far_field.glsl"
#include "haze_walk.glsl"

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
    bool isBlurred;  // as far_field.glsl has it
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
    brick.isBlurred = isBlurred(field, scale);
    brick.corner = vec3(cell >> scale << scale);
    brick.side = float(1u << scale);
    vec3 far = brick.corner + mix(vec3(0.0), vec3(brick.side), greaterThan(ray.pace, vec3(0.0)));
    vec3 way = mix((far - ray.start) * field.cellSide * ray.inverse, vec3(1e30),
                   lessThan(abs(ray.direction), vec3(kSmallestDirection)));
    brick.end = max(inside, min(way.x, min(way.y, way.z)));
    return brick;
}

// The next haze of a walk: of a large medium a part. Begins at the walk's end where there is none.
MediumPiece nextMedium(inout HazeWalk walk) {
    HazePart part = nextHaze(walk);
    if (part.medium == kNone) {
        return MediumPiece(walk.end, walk.end, 0.0, 0.0);
    }
    FarMedium haze = HazeArray(sceneTable.haze).at[part.medium];
    return MediumPiece(part.entry, part.exit, haze.extinction, haze.scattering);
}

#endif
