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
    -3.03712f, 0.90687f, -0.12888f, -0.00628f, 0.00362f,
    -0.02741f,
    -3.05601f, 0.98493f, -0.09080f, -0.00171f, -0.00363f,
    -0.02912f};

// 10 coefficients for each of: isotropic, lambertian.
NIGHTCITY_CONST float kAirlightPlain[20] = {
    0.26177f, 0.15563f, -0.22900f, -0.15496f, 0.11320f,
    -0.04491f, 0.04201f, -0.11846f, 0.18574f, 0.00605f,
    -1.19811f, 0.76056f, 0.70651f, 0.15282f, 0.00168f,
    -0.02907f, -0.02215f, -0.12148f, 0.08057f, 0.00569f};

// 10 coefficients for each of: isotropic, lambertian.
NIGHTCITY_CONST float kAirlightGraded[20] = {
    0.59825f, 0.06381f, -0.12228f, -0.01263f, -0.00543f,
    0.06616f, 0.00806f, -0.05500f, 0.07643f, 0.01034f,
    0.51865f, 0.01426f, -0.12433f, -0.00491f, 0.08495f,
    -0.07870f, 0.13409f, -0.00157f, -0.01373f, 0.04835f};

NIGHTCITY_END

#endif
