// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What the nodes of the far field do not hold of the light around each window, as energy of the
// cells that it passes: rays leave the window as its light does, and bring fluence times volume as
// they go. One thread a ray. Sums are integers, so that their order does not matter.
#version 460
#extension GL_GOOGLE_include_directive : require

// As path.comp: glslang 12 crashes while it spreads `precise` through this program.
#define precise
#define NIGHTCITY_KEEP_TABLES
#include "direct_light.glsl"
#include "order_cells.glsl"
#include "surface_shading.glsl"
#include "transport/near_far_split.h"
#include "transport/phase.h"

layout(local_size_x = kGroupSize) in;

const uint kStepsOfRadius = 8u;

// Of a window's light, from its points where it is a pane, else from its centre.
Ray emitted(Window window, uint number, uint count, inout RandomStream random) {
    vec2 u = nextRandomPair(random);
    u = vec2((float(number) + u.x) / float(count), fract(float(number) * kGoldenRatio + u.y));
    if ((window.flags & kWindowSphere) != 0u) {
        vec3 way = directionAbout(vec3(0.0, 0.0, 1.0), 1.0 - 2.0 * u.x, u.y);
        return Ray(window.centre + window.halfU.x * way, normalize(way));
    }
    vec3 normal = paneNormal(window);
    bool isIsotropic = kEmitter == kEmitterIsotropic;
    vec3 way = directionAbout(normal, isIsotropic ? 1.0 - u.x : sqrt(1.0 - u.x), u.y);
    vec2 at = kEmitter == kEmitterPane ? 2.0 * nextRandomPair(random) - 1.0 : vec2(0.0);
    return Ray(window.centre + at.x * window.halfU + at.y * window.halfV, normalize(way));
}

// m. Of a pane from before its own wall, which may reach as far in front of it.
float endOfEmitted(Ray ray, Window window) {
    if (kVisibility == 0u) {
        return kFar;
    }
    Ray inFront = Ray(ray.origin + kPaneOnWall * outward(window), ray.direction);
    return nearestTriangle(inFront, groundDepth(inFront)).depth;
}

// Rounded up as often as it is to the unit, so that weak windows beside strong ones are not lost.
void leave(vec3 place, vec3 energy, inout RandomStream random) {
    float side;
    uint cell = cellAbout(place, side);
    if (cell == kNone || side >= cellSideOf(ordersField, ordersField.blurredScale)) {
        return;  // nodes that hold near parts too
    }
    uvec3 units = uvec3(energy / ordersTable.energyUnit + nextRandom(random));
    for (uint channel = 0u; channel < 3u; ++channel) {
        atomicAdd(UintArray(ordersTable.nearEnergy).at[3u * cell + channel], units[channel]);
    }
}

void main() {
    keepOrdersTables();
    uint rays = push.sampleIndex;
    uint number = push.firstPixel * kGroupSize + gl_GlobalInvocationID.x;
    uint index = number / rays;
    if (index >= ordersTable.windowCount || !isLit(index)) {
        return;
    }
    Window window = WindowArray(sceneTable.windows).at[index];
    // Behind a window is its building.
    bool isHalf = kEmitter == kEmitterIsotropic && (window.flags & kWindowSphere) == 0u;
    vec3 power = (isHalf ? 0.5 : 1.0) / float(rays) * window.power * window.colour;
    RandomStream random = RandomStream(pcg4d(uvec4(index, number % rays, 2u, 0u)), 0u);
    Ray ray = emitted(window, number % rays, rays, random);
    float radius = ordersField.nearRadius;
    float end = min(endOfEmitted(ray, window), radius + length(ray.origin - window.centre));
    HazeWalk walk = hazeWalk(ray, end);
    float depth = 0.0;
    for (HazePart part = nextHaze(walk); part.medium != kNone; part = nextHaze(walk)) {
        FarMedium haze = HazeArray(sceneTable.haze).at[part.medium];
        uint steps = uint(ceil((part.exit - part.entry) / radius * float(kStepsOfRadius)));
        float step = (part.exit - part.entry) / float(max(steps, 1u));
        for (uint i = 0u; i < steps; ++i) {
            float at = part.entry + (float(i) + 0.5) * step;
            vec3 place = ray.origin + at * ray.direction;
            float y = squared(place - window.centre) / (radius * radius);
            float share = nearShare(y) * exp(-depth - 0.5 * haze.extinction * step);
            leave(place, share * step * power, random);
            depth += haze.extinction * step;
        }
    }
}
