// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// exp(-x) for x >= 0 to a few units in the last place, the same on every
// device; drivers may be off by 3 + 2|x| units. Binding-free.
#ifndef NIGHTCITY_TRANSPORT_EXPONENTIAL_GLSL
#define NIGHTCITY_TRANSPORT_EXPONENTIAL_GLSL

float expNegative(float x) {
    return exp(-x);
}

#endif
