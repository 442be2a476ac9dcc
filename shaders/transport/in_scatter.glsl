// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Single scattering of isotropic points of light in homogeneous haze (design
// section 4; Brito, Real-time Night City Rendering). Binding-free.
#ifndef NIGHTCITY_TRANSPORT_IN_SCATTER_GLSL
#define NIGHTCITY_TRANSPORT_IN_SCATTER_GLSL

#include "constants.glsl"

// m^2, only against division by zero where a step falls on a light.
const float kSmallestDistance2 = 1e-12;

// exp(-extinction d - opticalDepth) / d^2, in 1/m^2: what a point of light of
// 4 pi W gives as fluence at `toLight` m from it, seen through haze of
// `opticalDepth` before the eye.
float attenuatedInverseSquare(vec3 toLight, float extinction, float opticalDepth) {
    float distance2 = max(dot(toLight, toLight), kSmallestDistance2);
    return exp(-(extinction * sqrt(distance2) + opticalDepth)) / distance2;
}

// The factor that turns sums over steps of power x attenuatedInverseSquare into
// radiance: phase 1/(4 pi), point intensity 1/(4 pi), scattering in 1/m, step in m.
float inScatterScale(float scattering, float stepLength) {
    return kInverse4Pi * kInverse4Pi * scattering * stepLength;
}

#endif
