// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the far field at given places, one a thread; -1 where there is no brick.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "far_field.glsl"

layout(local_size_x = 256) in;

layout(set = 0, binding = 0, scalar) readonly buffer Places {
    vec3 places[];
};
layout(set = 0, binding = 1, scalar) writeonly buffer Answers {
    vec4 answers[];  // fluence and the estimate of its error
};

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= places.length()) {
        return;
    }
    FarFieldTable field = farFieldTable;
    uint found = brickAt(field, ivec3(floor((places[index] - field.origin) / field.cellSide)));
    if (found == kNone) {
        answers[index] = vec4(-1.0);
        return;
    }
    FarBrick brick = FarBrickArray(field.bricks).at[found];
    vec3 place = (places[index] - brickCorner(field, brick)) / brickSide(field, brick);
    answers[index] = farSample(field, found, place);
}
