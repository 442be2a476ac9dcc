// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers as the unevaluated sum of two floats, about 48 bits: where a ray of
// hundreds of metres ends beside a light, float alone leaves 1e-5 m of doubt.
// Dekker, A floating-point technique for extending the available precision,
// Numer. Math. 18 (1971); Knuth, TAOCP 2, 4.2.2. No fused operation is assumed.
#ifndef NIGHTCITY_SHADERS_TWO_FLOAT_GLSL
#define NIGHTCITY_SHADERS_TWO_FLOAT_GLSL

struct TwoFloat {
    float hi;
    float lo;
};

TwoFloat twoSum(float a, float b) {
    precise float sum = a + b;
    precise float part = sum - a;
    precise float error = (a - (sum - part)) + (b - part);
    return TwoFloat(sum, error);
}

// |a| >= |b|
TwoFloat quickTwoSum(float a, float b) {
    precise float sum = a + b;
    precise float error = b - (sum - a);
    return TwoFloat(sum, error);
}

TwoFloat split(float a) {
    precise float scaled = 4097.0 * a;  // 2^12 + 1
    precise float hi = scaled - (scaled - a);
    precise float lo = a - hi;
    return TwoFloat(hi, lo);
}

TwoFloat twoProduct(float a, float b) {
    precise float product = a * b;
    TwoFloat x = split(a);
    TwoFloat y = split(b);
    precise float error =
        ((x.hi * y.hi - product) + x.hi * y.lo + x.lo * y.hi) + x.lo * y.lo;
    return TwoFloat(product, error);
}

TwoFloat add(TwoFloat a, TwoFloat b) {
    TwoFloat sum = twoSum(a.hi, b.hi);
    precise float error = sum.lo + (a.lo + b.lo);
    return quickTwoSum(sum.hi, error);
}

TwoFloat subtract(TwoFloat a, TwoFloat b) {
    return add(a, TwoFloat(-b.hi, -b.lo));
}

TwoFloat multiply(TwoFloat a, TwoFloat b) {
    TwoFloat product = twoProduct(a.hi, b.hi);
    precise float error = product.lo + (a.hi * b.lo + a.lo * b.hi);
    return quickTwoSum(product.hi, error);
}

TwoFloat divide(TwoFloat a, TwoFloat b) {
    precise float first = a.hi / b.hi;
    TwoFloat rest = subtract(a, multiply(b, TwoFloat(first, 0.0)));
    precise float second = rest.hi / b.hi;
    return quickTwoSum(first, second);
}

float toFloat(TwoFloat a) {
    return a.hi + a.lo;
}

#endif
