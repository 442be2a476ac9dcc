// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws from a path's stream of random numbers.
#ifndef NIGHTCITY_SHADERS_PATH_RANDOM_GLSL
#define NIGHTCITY_SHADERS_PATH_RANDOM_GLSL

#include "transport/random.h"

// Turns: points that go on by so much each, one after the other, lie evenly however many there are.
const float kGoldenRatio = 0.6180339887;

// Each in [0, 1).
vec2 nextRandomPair(inout RandomStream random) {
    return randomPair(random.key, random.drawn++);
}

float nextRandom(inout RandomStream random) {
    vec2 pair = nextRandomPair(random);
    return pair.x;
}

#endif
