// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Unbiased Monte Carlo: paths from the camera, with light drawn from the windows at each
// event (next event estimation) and the haze on the camera's ray always met, by weight.
// The order of a path is the number of its events: scattering in haze, reflection by a
// surface.
#version 460
#extension GL_GOOGLE_include_directive : require

// glslang 12 crashes while it spreads `precise` through this program. No path needs it: it is
// there for segments that share an end to the bit.
#define precise

#include "counters.glsl"
#include "path_ends.glsl"

layout(local_size_x = kGroupSize) in;

// Russian roulette from this order on, and never with less than one path in twenty ended.
const uint kRouletteOrder = 4;
const float kMostSurvival = 0.95;

struct Path {
    Ray ray;          // unit direction
    vec3 throughput;
    uint order;       // of the next event
};

bool wanted(uint order) {
    return order >= frameTable.firstOrder && order <= frameTable.lastOrder;
}

HazeSpan hazeOn(Ray ray, float end) {
    if (kMedia == 0u) {
        return HazeSpan(kFar, 0.0, 0.0);
    }
    return hazeSpan(ray, end);
}

Path scattered(Path path, HazePoint haze, inout RandomStream random) {
    vec2 u = nextRandomPair(random);
    vec3 origin = path.ray.origin + haze.distance * path.ray.direction;
    vec3 direction =
        directionAbout(path.ray.direction, phaseCosine(frameTable.anisotropy, u.x), u.y);
    float albedo = haze.scattering / haze.extinction;
    return Path(Ray(origin, normalize(direction)), albedo * path.throughput, path.order + 1u);
}

Path reflected(Path path, RayEnd end, inout RandomStream random) {
    vec2 u = nextRandomPair(random);
    vec3 origin =
        path.ray.origin + end.distance * path.ray.direction + kOffSurface * end.normal;
    vec3 direction = directionAbout(end.normal, sqrt(1.0 - u.x), u.y);
    return Path(Ray(origin, normalize(direction)), path.throughput * end.reflectance,
                path.order + 1u);
}

bool survives(inout Path path, inout RandomStream random) {
    float most = max(path.throughput.r, max(path.throughput.g, path.throughput.b));
    if (path.order < kRouletteOrder) {
        return most > 0.0;
    }
    float survival = min(most, kMostSurvival);
    if (nextRandom(random) >= survival) {
        return false;
    }
    path.throughput /= survival;
    return true;
}

// What the rest of a path brings.
vec3 walk(Path path, inout RandomStream random) {
    vec3 light = vec3(0.0);
    while (path.order <= frameTable.lastOrder && survives(path, random)) {
        RayEnd end = endOf(path.ray);
        HazeSpan span = hazeOn(path.ray, end.distance);
        if (wanted(path.order)) {
            light += path.throughput * inScatteredLight(path.ray, span, 0.0, random);
        }
        float depth = depthOfShare(nextRandom(random));
        if (depth < span.depth) {
            path = scattered(path, hazeAtDepth(path.ray, span.end, depth), random);
        } else if (end.reflectance != vec3(0.0)) {
            if (wanted(path.order)) {
                light += path.throughput * reflectedLight(path.ray, end, random);
            }
            path = reflected(path, end, random);
        } else {
            break;
        }
    }
    return light;
}

// Of the haze before the first surface.
vec3 glowOf(Ray ray, HazeSpan span, float nearShare, inout RandomStream random) {
    vec3 light = wanted(1) ? inScatteredLight(ray, span, nearShare, random) : vec3(0.0);
    if (frameTable.lastOrder == 1 || span.depth <= 0.0) {
        return light;
    }
    float colliding = collisionProbability(span.depth);
    float depth = depthOfShare(nextRandom(random) * colliding);
    Path path = Path(ray, vec3(colliding), 1u);
    return light + walk(scattered(path, hazeAtDepth(ray, span.end, depth), random), random);
}

// Of the first surface, before the haze in front of it.
vec3 reflectedBy(Ray ray, RayEnd end, inout RandomStream random) {
    vec3 light = wanted(1) ? reflectedLight(ray, end, random) : vec3(0.0);
    if (frameTable.lastOrder == 1) {
        return light;
    }
    return light + walk(reflected(Path(ray, vec3(1.0), 1u), end, random), random);
}

void finish(uint index, SurfaceRecord surface, float opticalDepth, int mediaId, PathSums sums) {
    float weight = 1.0 / float(frameTable.paths);
    RayProgress progress;
    progress.lastEntry = 0.0;
    progress.lastBox = kNone;
    progress.segments = 0u;
    progress.firstMediaId = mediaId;
    progress.glow = weight * sums.glow;
    progress.opticalDepth = opticalDepth;
    RayProgressArray(frameTable.progress).at[index] = progress;
    // What surfaces emit, and what the dim view shows of them, is part of the first order.
    vec3 seen = wanted(1) ? surface.radiance : vec3(0.0);
    SurfaceRecordArray(frameTable.surfaces).at[index].radiance = seen + weight * sums.reflected;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.pixelCount) {
        return;
    }
    uvec2 pixel = pixelOf(push.firstPixel + index);
    Ray view = cameraRay(pixel, push.sampleIndex);
    float scale = length(view.direction);
    Ray ray = Ray(view.origin, view.direction / scale);
    SurfaceRecord surface = SurfaceRecordArray(frameTable.surfaces).at[index];
    RayEnd end = RayEnd(surface.depth * scale, surface.normal,
                        kLit != 0u ? reflectanceOf(surface) : vec3(0.0));
    HazeSpan span = hazeOn(ray, end.distance);
    if (push.round == 0u) {
        findNearLights(ray, span.begin, span.end);
        NearLightsArray(frameTable.nearLights).at[index] = nearLights;
    } else {
        nearLights = NearLightsArray(frameTable.nearLights).at[index];
    }
    PathSums sums = PathSums(vec3(0.0), vec3(0.0));
    vec3 squares = vec3(0.0);
    uint first = push.round * kPathsPerDispatch;
    uint count = min(kPathsPerDispatch, frameTable.paths - first);
    for (uint i = 0; i < count; ++i) {
        uint number = push.sampleIndex * frameTable.paths + first + i;
        RandomStream random = randomStream(pixel, number, frameTable.seed);
        vec3 glow = glowOf(ray, span, nearShareOf(nearLights), random);
        sums.glow += glow;
        squares += glow * glow;
        if (end.reflectance != vec3(0.0)) {
            sums.reflected += reflectedBy(ray, end, random);
        }
    }
    if (push.round > 0u) {
        sums.glow += PathSumsArray(frameTable.pathSums).at[index].glow;
        sums.reflected += PathSumsArray(frameTable.pathSums).at[index].reflected;
    }
    if (push.round > 0u || push.sampleIndex > 0u) {
        squares += Vec3Array(frameTable.glowSquares).at[index];
    }
    Vec3Array(frameTable.glowSquares).at[index] = squares;
    PathSumsArray(frameTable.pathSums).at[index] = sums;
    if (first + count == frameTable.paths) {
        finish(index, surface, span.depth, kMedia == 0u ? -1 : firstMediaId(ray, end.distance),
               sums);
    }
    countLights(lightSamples);
}
