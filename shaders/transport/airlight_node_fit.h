// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Written by fit_airlight_nodes.py: edit that, not this. The quadratic forms that
// airlight_nodes.h evaluates. Binding-free.
#ifndef NIGHTCITY_TRANSPORT_AIRLIGHT_NODE_FIT_H
#define NIGHTCITY_TRANSPORT_AIRLIGHT_NODE_FIT_H

#include "arithmetic.h"

NIGHTCITY_BEGIN

// 6 coefficients for each of: isotropic, lambertian.
NIGHTCITY_CONST float kAirlightOne[12] = {
    -3.03319f, 0.90521f, -0.13032f, -0.00637f, 0.00380f,
    -0.02736f,
    -3.10750f, 0.98148f, -0.07414f, -0.00179f, -0.00283f,
    -0.02984f};

// 10 coefficients for each of: isotropic, lambertian.
NIGHTCITY_CONST float kAirlightPlain[20] = {
    0.11081f, 0.21773f, -0.23882f, -0.10800f, 0.11378f,
    -0.12440f, 0.04362f, -0.07743f, 0.16501f, 0.00467f,
    -1.29599f, 0.77193f, 0.73405f, 0.14715f, 0.00447f,
    -0.00722f, -0.02526f, -0.16771f, 0.10097f, 0.00523f};

// 10 coefficients for each of: isotropic, lambertian.
NIGHTCITY_CONST float kAirlightGraded[20] = {
    0.60245f, 0.03771f, -0.09687f, -0.03649f, -0.00768f,
    0.06673f, 0.00954f, -0.05555f, 0.07439f, 0.01258f,
    0.60538f, -0.13463f, 0.00526f, -0.13856f, 0.08137f,
    -0.05934f, 0.14277f, -0.01361f, -0.01447f, 0.05927f};

NIGHTCITY_END

#endif
