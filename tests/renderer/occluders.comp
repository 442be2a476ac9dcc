// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Walks the tree of occluders on the device, one query a thread.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "occluders.glsl"
#include "occluders_query.h"

layout(local_size_x = 256) in;

layout(set = 0, binding = 0, scalar) readonly buffer Queries {
    OccludersQuery queries[];
};
layout(set = 0, binding = 1, scalar) writeonly buffer Answers {
    OccludersAnswer answers[];
};

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= queries.length()) {
        return;
    }
    OccludersQuery q = queries[index];
    Between between = q.isBox != 0u
                          ? betweenBoxAndBox(q.origin, q.nearHalf, q.begin, q.farHalf)
                          : betweenBoxAndStretch(q.origin, q.nearHalf, q.begin, q.end);
    uint count = 0u;
    uint walk = 0u;
    for (uint face = nextOccluder(walk, between); face != kNone;
         face = nextOccluder(walk, between)) {
        if (count < kMostFaces) {
            answers[index].face[count] = face;
        }
        ++count;
    }
    answers[index].count = count;
}
