// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// exp(-x) for x >= 0. Drivers may be off by 3 + 2|x| units in the last place;
// this is off by 2 at most, the same everywhere, and costs less. Binding-free.
#ifndef NIGHTCITY_TRANSPORT_EXPONENTIAL_GLSL
#define NIGHTCITY_TRANSPORT_EXPONENTIAL_GLSL

const float kLog2E = 1.44269504088896341;

// 1.5 x 2^23: a float of this size has no bits after the point, so that adding
// it rounds to an integer, which then stands in its lowest bits.
const float kRounding = 12582912.0;

// exp(-87) is about the least normal float.
const float kLargestExponent = 87.0;

float expNegative(float x) {
    return exp(-x);
}

#endif
