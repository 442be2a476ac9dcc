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
    float clamped = min(x, kLargestExponent);
    precise float shifted = fma(clamped, -kLog2E, kRounding);
    precise float whole = shifted - kRounding;
    float part = fma(clamped, -kLog2E, -whole);  // -0.5 to 0.5
    // 2^part: minimax of degree 5 with value 1 at 0, relative error 9.2e-8 at most.
    float power = fma(part, 1.3264727e-3, 9.6715126e-3);
    power = fma(part, power, 5.5507337e-2);
    power = fma(part, power, 2.4022242e-1);
    power = fma(part, power, 6.9314698e-1);
    power = fma(part, power, 1.0);
    return uintBitsToFloat(floatBitsToUint(power) + (floatBitsToUint(shifted) << 23));
}

#endif
