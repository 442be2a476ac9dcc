// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Trigonometry by minimax polynomials, the same on every device. Vulkan lets
// atan be wrong by 4096 units in the last place and sin and cos by 2^-11 (its
// specification, "Precision of GLSL.std.450 Instructions"), too coarse for
// angles that are differences. Binding-free.
//
// Largest errors, float arithmetic included, as the tests measure them:
// relative 2e-7 for atanUnit and arcOf, relative 2e-7 for the sine and absolute
// 1.3e-7 for the cosine of quarterTurn. Cost: 8, 12 and 12 multiply-adds, and
// one division and a few selections for arcOf.
#ifndef NIGHTCITY_TRANSPORT_POLYNOMIAL_TRIG_H
#define NIGHTCITY_TRANSPORT_POLYNOMIAL_TRIG_H

#include "arithmetic.h"

NIGHTCITY_BEGIN

NIGHTCITY_CONST float kQuarterTurn = 1.57079632679489662f;  // rad
NIGHTCITY_CONST float kHalfTurn = 3.14159265358979324f;     // rad

// atan(x) in rad, |x| <= 1. Relative error of the polynomial 1.6e-8.
NIGHTCITY_FUNCTION float atanUnit(float x) {
    float y = x * x;
    float p = 0.002849888885f;
    p = p * y - 0.01606862603f;
    p = p * y + 0.04269151452f;
    p = p * y - 0.07504294139f;
    p = p * y + 0.1064093384f;
    p = p * y - 0.1420364442f;
    p = p * y + 0.1999261939f;
    p = p * y - 0.3333307334f;
    p = p * y + 0.9999999848f;
    return p * x;
}

// The angle in [0, pi] whose sine and cosine are in the proportion sine : cosine;
// sine >= 0, and not both 0. atan2(sine, cosine).
NIGHTCITY_FUNCTION float arcOf(float sine, float cosine) {
    float size = abs(cosine);
    float arc = atanUnit(min(sine, size) / max(sine, size));
    arc = sine > size ? kQuarterTurn - arc : arc;
    return cosine < 0.0f ? kHalfTurn - arc : arc;
}

// (sin a, cos a) for a in [0, pi/2] rad. Errors of the polynomials 6e-9 and 3e-10.
NIGHTCITY_FUNCTION vec2 quarterTurn(float a) {
    float y = a * a;
    float s = 2.601903067e-6f;
    s = s * y - 0.0001980741873f;
    s = s * y + 0.008333025139f;
    s = s * y - 0.1666665668f;
    s = s * y + 0.9999999947f;
    float c = -2.605149517e-7f;
    c = c * y + 2.476016135e-5f;
    c = c * y - 0.00138883614f;
    c = c * y + 0.04166663626f;
    c = c * y - 0.4999999936f;
    c = c * y + 0.9999999998f;
    return vec2(s * a, c);
}

NIGHTCITY_END

#endif
