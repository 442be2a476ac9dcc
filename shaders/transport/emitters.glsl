// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Emitters: power, area and radiance. Binding-free.
#ifndef NIGHTCITY_TRANSPORT_EMITTERS_GLSL
#define NIGHTCITY_TRANSPORT_EMITTERS_GLSL

#include "constants.glsl"

// m^2, of the rectangle with these half edges.
float paneArea(vec3 halfU, vec3 halfV) {
    return 4.0 * length(cross(halfU, halfV));
}

// W m^-2 sr^-1 of a Lambertian emitter of `power` W over `area` m^2.
float lambertianRadiance(float power, float area) {
    return power / (kPi * area);
}

#endif
