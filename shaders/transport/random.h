// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Random numbers by counting: number n of a path depends on nothing but the path's
// key and n, so that bands, pixel lists and the order of the work change nothing.
// Binding-free.
#ifndef NIGHTCITY_TRANSPORT_RANDOM_H
#define NIGHTCITY_TRANSPORT_RANDOM_H

#include "arithmetic.h"

NIGHTCITY_BEGIN

// PCG in four dimensions: Jarzynski and Olano 2020, Hash functions for GPU
// rendering, JCGT 9 (3), listing 16. A bijection of 128 bits.
NIGHTCITY_FUNCTION uvec4 pcg4d(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v = v ^ (v >> 16u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

struct RandomStream {
    uvec4 key;
    uint drawn;
};

// Path number `path` of a pixel.
NIGHTCITY_FUNCTION RandomStream randomStream(uvec2 pixel, uint path, uvec2 seed) {
    RandomStream stream;
    stream.key = pcg4d(uvec4(pixel.x | (pixel.y << 16u), path, seed.x, seed.y));
    stream.drawn = 0u;
    return stream;
}

// The top 24 bits as a number in [0, 1).
NIGHTCITY_FUNCTION float unitFloat(uint bits) {
    return float(bits >> 8u) * 5.9604644775390625e-8f;
}

NIGHTCITY_FUNCTION vec2 randomPair(uvec4 key, uint number) {
    uvec4 bits = pcg4d(uvec4(key.x, key.y, key.z, key.w + number));
    return vec2(unitFloat(bits.x), unitFloat(bits.z));
}

NIGHTCITY_END

#endif
