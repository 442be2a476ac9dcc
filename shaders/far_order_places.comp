// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// From where the nodes of higher orders look: one on a wall from the air before it.
#version 460
#extension GL_GOOGLE_include_directive : require

#define NIGHTCITY_KEEP_TABLES
#include "far_places.glsl"
#include "order_cells.glsl"

layout(local_size_x = kNodeThreads) in;

// And 1; 0 in a solid.
vec4 lookOut(vec3 node) {
    for (uint i = 0u; i < 8u; ++i) {
        vec3 place = node + 2.0 * kOnFace * (vec3(cornerOf(i)) * 2.0 - 1.0);
        if (!isInSolid(place)) {
            return vec4(place, 1.0);
        }
    }
    return vec4(0.0);
}

void main() {
    keepOrdersTables();
    bakeTable = FarBakeReference(ordersTable.bake).table;
    uint thread = gl_LocalInvocationIndex;
    if (thread >= kOrderNodes) {
        return;
    }
    FarBrick brick = FarBrickArray(ordersField.bricks).at[orderBrick()];
    float step = brickSide(ordersField, brick) / float(kOrderSteps);
    vec3 node = brickCorner(ordersField, brick) + step * vec3(orderNodePlace(thread));
    Vec4Array(ordersTable.nodes).at[orderBrick() * kOrderNodes + thread] = lookOut(node);
}
