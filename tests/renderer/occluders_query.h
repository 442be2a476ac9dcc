// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What occluders_test.cpp asks occluders.comp, byte for byte.
#ifndef NIGHTCITY_TESTS_OCCLUDERS_QUERY_H
#define NIGHTCITY_TESTS_OCCLUDERS_QUERY_H

#include "dispatch.h"

NIGHTCITY_BEGIN

NIGHTCITY_CONST uint kMostFaces = 60u;

struct OccludersQuery {
    vec3 origin;    // m
    vec3 nearHalf;  // m
    vec3 begin;     // m, from the origin
    vec3 end;
    vec3 farHalf;   // m, of the box about `begin` where isBox is 1
    uint isBox;
};

struct OccludersAnswer {
    uint count;  // faces found, also those beyond kMostFaces
    uint face[kMostFaces];
};

NIGHTCITY_END

#endif
