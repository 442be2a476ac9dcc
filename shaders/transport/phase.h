// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Directions after an event, and the phase function of Henyey and Greenstein 1941
// (Diffuse radiation in the galaxy, Astrophysical Journal 93). Binding-free.
#ifndef NIGHTCITY_TRANSPORT_PHASE_H
#define NIGHTCITY_TRANSPORT_PHASE_H

#include "arithmetic.h"

NIGHTCITY_BEGIN

// 1/sr, for the cosine between the directions of flight before and after; g in
// (-1, 1), 0 is isotropic.
NIGHTCITY_FUNCTION float phaseFunction(float g, float cosine) {
    float base = max(1.0f + g * g - 2.0f * g * cosine, 1e-9f);
    return 0.0795774715459477f * (1.0f - g * g) / (base * sqrt(base));
}

// The cosine whose distribution function is at `u` in [0, 1).
NIGHTCITY_FUNCTION float phaseCosine(float g, float u) {
    if (abs(g) < 1e-3f) {  // to first order in g: the exact inverse divides by g
        float c = 1.0f - 2.0f * u;
        return clamp(c + 1.5f * g * (1.0f - c * c), -1.0f, 1.0f);
    }
    float share = (1.0f - g * g) / (1.0f + g - 2.0f * g * u);
    return clamp((1.0f + g * g - share * share) / (2.0f * g), -1.0f, 1.0f);
}

// The unit vector at an angle from `axis` (a unit vector), turned about it by `turn`
// (1: all the way round). Basis: Duff et al. 2017, Building an orthonormal basis,
// revisited, JCGT 6 (1).
NIGHTCITY_FUNCTION vec3 directionAbout(vec3 axis, float cosine, float turn) {
    float side = axis.z >= 0.0f ? 1.0f : -1.0f;
    float a = -1.0f / (side + axis.z);
    float b = axis.x * axis.y * a;
    vec3 first = vec3(1.0f + side * axis.x * axis.x * a, side * b, -side * axis.x);
    vec3 second = vec3(b, side + axis.y * axis.y * a, -axis.y);
    float sine = sqrt(max(1.0f - cosine * cosine, 0.0f));
    float angle = 6.28318530717958648f * (turn - 0.5f);  // where sin and cos are precise
    return (sine * cos(angle)) * first + (sine * sin(angle)) * second + cosine * axis;
}

NIGHTCITY_END

#endif
