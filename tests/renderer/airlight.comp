// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Evaluates the air-light formulas on the device, one query a thread.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

#include "airlight_query.h"

layout(local_size_x = 256) in;

layout(set = 0, binding = 0, scalar) readonly buffer Queries {
    AirlightQuery queries[];
};
layout(set = 0, binding = 1, scalar) writeonly buffer Answers {
    AirlightAnswer answers[];
};

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= queries.length()) {
        return;
    }
    AirlightQuery q = queries[index];
    AirlightAnswer answer;
    answer.isotropic = airlightIsotropic(q.interval, q.extinction, q.tolerance);
    answer.lambertian =
        airlightLambertian(q.interval, q.direction, q.normal, q.extinction, q.tolerance);
    answer.pane = airlightPane(q.fromCentre, q.direction, q.halfU, q.halfV, 0.0, q.end,
                               q.extinction, q.tolerance);
    answers[index] = answer;
}
