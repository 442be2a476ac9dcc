// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// A ray through a lattice of cubic cells, cell by cell (Amanatides and Woo 1987, A fast
// voxel traversal algorithm for ray tracing).
#ifndef NIGHTCITY_SHADERS_LATTICE_WALK_GLSL
#define NIGHTCITY_SHADERS_LATTICE_WALK_GLSL

#include "box_interval.glsl"
#include "camera_ray.glsl"

struct Lattice {
    vec3 origin;   // m, lower corner
    float side;    // m, of a cell
    ivec3 counts;  // cells along each axis
};

struct LatticeWalk {
    ivec3 cell;
    ivec3 step;   // -1, 0 or 1 along each axis
    vec3 next;    // m along the ray to the next plane of each axis
    vec3 pace;    // m between two planes
};

// The walk from `begin`; `inverse` is reciprocal(ray.direction).
LatticeWalk latticeWalk(Ray ray, vec3 inverse, float begin, Lattice lattice) {
    LatticeWalk walk;
    vec3 place = (ray.origin + begin * ray.direction - lattice.origin) / lattice.side;
    walk.cell = clamp(ivec3(floor(place)), ivec3(0), lattice.counts - 1);
    walk.step = ivec3(sign(ray.direction));
    for (int axis = 0; axis < 3; ++axis) {
        if (abs(ray.direction[axis]) < kSmallestDirection) {
            walk.step[axis] = 0;
        }
    }
    walk.pace = abs(lattice.side * inverse);
    vec3 plane = lattice.origin + vec3(walk.cell + max(walk.step, ivec3(0))) * lattice.side;
    walk.next = mix((plane - ray.origin) * inverse, vec3(1e30), equal(walk.step, ivec3(0)));
    return walk;
}

float cellExit(LatticeWalk walk) {
    return min(walk.next.x, min(walk.next.y, walk.next.z));
}

bool insideLattice(LatticeWalk walk, Lattice lattice) {
    return all(greaterThanEqual(walk.cell, ivec3(0))) &&
           all(lessThan(walk.cell, lattice.counts));
}

// Number of the cell, x fastest.
uint latticeCell(LatticeWalk walk, Lattice lattice) {
    ivec3 counts = lattice.counts;
    return uint((walk.cell.z * counts.y + walk.cell.y) * counts.x + walk.cell.x);
}

void stepOn(inout LatticeWalk walk) {
    if (walk.next.x <= walk.next.y && walk.next.x <= walk.next.z) {
        walk.cell.x += walk.step.x;
        walk.next.x += walk.pace.x;
    } else if (walk.next.y <= walk.next.z) {
        walk.cell.y += walk.step.y;
        walk.next.y += walk.pace.y;
    } else {
        walk.cell.z += walk.step.z;
        walk.next.z += walk.pace.z;
    }
}

#endif
