// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The fluence that reaches a point from the haze in the cells around it, and from surfaces where
// they are lit, that light has reached before (Hottel and Sarofim 1967, Radiative transfer, has
// zones of haze; here rays lead to them).
#ifndef NIGHTCITY_SHADERS_ORDER_RAYS_GLSL
#define NIGHTCITY_SHADERS_ORDER_RAYS_GLSL

#include "order_cells.glsl"
#include "path_ends.glsl"

layout(constant_id = NIGHTCITY_CONSTANT_GATHER) const uint kGather = kGatherFirst;

const float kDeepest = 16.0;  // optical depth beyond which no ray looks

// Of the fluence in a cell what was scattered or reflected before, W m^-2.
vec3 scatteredAt(uint cell) {
    if (kGather == kGatherAll) {
        return Vec3Array(ordersTable.higher).at[cell] +
               ordersTable.tail * Vec3Array(cellsOfOrder(ordersTable.lastOrder)).at[cell];
    }
    return Vec3Array(cellsOfOrder(push.round - 1u)).at[cell];
}

// And on a surface there, W m^-2: between what the three sides get that it faces.
vec3 irradianceAt(uint cell, vec3 normal) {
    uvec3 sides = uvec3(0u, 1u, 2u) + mix(uvec3(0u), uvec3(3u), lessThan(normal, vec3(0.0)));
    vec3 irradiance = vec3(0.0);
    for (uint axis = 0u; axis < 3u; ++axis) {
        uint side = kCellSides * cell + sides[axis];
        vec3 got = Vec3Array(kGather == kGatherAll ? ordersTable.higherSides
                                                   : sidesOfOrder(push.round - 1u)).at[side];
        if (kGather == kGatherAll) {
            got += ordersTable.tail * Vec3Array(sidesOfOrder(ordersTable.lastOrder)).at[side];
        }
        irradiance += normal[axis] * normal[axis] * got;
    }
    return irradiance;
}

// Of the fluence in a cell all that is scattered on.
vec3 sourceOf(uint cell) {
    vec3 direct = kGather == kGatherAll ? Vec3Array(ordersTable.first).at[cell] : vec3(0.0);
    return direct + scatteredAt(cell);
}

// Of a ray that was scattered into by the haze on it, divided by 4 pi: W m^-2 sr^-1.
vec3 hazeAlong(Ray ray, float end, out float depth, out uint last) {
    HazeWalk walk = hazeWalk(ray, end);
    vec3 light = vec3(0.0);
    float side = cellSideOf(ordersField, 0u);
    depth = 0.0;
    last = kNone;
    for (HazePart part = nextHaze(walk); part.medium != kNone && depth < kDeepest;
         part = nextHaze(walk)) {
        FarMedium haze = HazeArray(sceneTable.haze).at[part.medium];
        float albedo = haze.extinction > 0.0 ? haze.scattering / haze.extinction : 0.0;
        for (float at = part.entry; at < part.exit && depth < kDeepest;) {
            float step = min(side, part.exit - at);
            uint cell = cellAbout(ray.origin + (at + 0.5 * step) * ray.direction, side);
            float within = haze.extinction * step;
            if (cell != kNone) {
                light += albedo * exp(-depth) * collisionProbability(within) * sourceOf(cell);
                last = cell;
            }
            depth += within;
            at = step < part.exit - at ? at + step : part.exit;
        }
    }
    return light;
}

// The mean over all directions of the light that comes along a ray, times 4 pi: W m^-2.
vec3 lightAlong(Ray ray, inout RandomStream random) {
    RayEnd end = endOf(ray);
    float depth;
    uint last;
    vec3 light = hazeAlong(ray, end.distance, depth, last);
    if (kLit == 0u || end.reflectance == vec3(0.0)) {
        return light;
    }
    vec3 reflected = vec3(0.0);
    if (kGather != kGatherNext) {
        reflected = reflectedLight(ray, end, random);
    }
    if (kGather != kGatherFirst && last != kNone) {
        reflected += end.reflectance / kPi * irradianceAt(last, end.normal);
    }
    return light + 4.0 * kPi * exp(-depth) * reflected;
}

vec3 directionOf(uint number, uint count, vec2 turn) {
    float z = 1.0 - 2.0 * (float(number) + turn.x) / float(count);
    float angle = 2.0 * kPi * fract(float(number) * kGoldenRatio + turn.y);
    float across = sqrt(max(1.0 - z * z, 0.0));
    return normalize(vec3(across * cos(angle), across * sin(angle), z));
}

// What comes to a place.
struct Gathered {
    vec3 fluence;            // W m^-2
    vec3 sides[kCellSides];  // W m^-2, irradiance; where surfaces are lit
};

// `name`: one for each place.
Gathered gatherAt(vec3 place, uvec3 name) {
    frameTable.reach = 1e15;  // m, all: directLight asks
    RandomStream random = RandomStream(pcg4d(uvec4(name, push.round)), 0u);
    vec2 turn = nextRandomPair(random);
    float share = 1.0 / float(push.sampleIndex);
    Gathered gathered;
    gathered.fluence = vec3(0.0);
    for (uint side = 0u; side < kCellSides; ++side) {
        gathered.sides[side] = vec3(0.0);
    }
    for (uint i = 0u; i < push.sampleIndex; ++i) {
        Ray ray = Ray(place, directionOf(i, push.sampleIndex, turn));
        vec3 light = share * lightAlong(ray, random);
        gathered.fluence += light;
        if (kLit != 0u && kGather != kGatherAll) {
            for (uint axis = 0u; axis < 3u; ++axis) {
                gathered.sides[axis] += max(ray.direction[axis], 0.0) * light;
                gathered.sides[axis + 3u] += max(-ray.direction[axis], 0.0) * light;
            }
        }
    }
    return gathered;
}

#endif
