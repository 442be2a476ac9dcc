// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What airlight_device_test.cpp asks airlight.comp, byte for byte.
#ifndef NIGHTCITY_TESTS_AIRLIGHT_QUERY_H
#define NIGHTCITY_TESTS_AIRLIGHT_QUERY_H

#include "transport/airlight_pane.h"

NIGHTCITY_BEGIN

struct AirlightQuery {
    AirlightInterval interval;
    vec3 direction;
    vec3 normal;
    vec3 fromCentre;  // of a pane, seen by the same ray from 0 to `end`
    vec3 halfU;
    vec3 halfV;
    float end;
    float extinction;
    float tolerance;
};

struct AirlightAnswer {
    float isotropic;
    float lambertian;
    float pane;
};

NIGHTCITY_END

#endif
