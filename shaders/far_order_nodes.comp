// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// All orders from the second on at the nodes, from what the cells hold.
#version 460
#extension GL_GOOGLE_include_directive : require

// As path.comp: glslang 12 crashes while it spreads `precise` through this program.
#define precise
#define NIGHTCITY_KEEP_TABLES
#include "order_rays.glsl"

layout(local_size_x = kNodeThreads) in;

void main() {
    keepOrdersTables();
    uint thread = gl_LocalInvocationIndex;
    if (thread >= kOrderNodes) {
        return;
    }
    FarBrick brick = FarBrickArray(ordersField.bricks).at[orderBrick()];
    uint node = orderBrick() * kOrderNodes + thread;
    vec4 place = Vec4Array(ordersTable.nodes).at[node];
    if (place.w > 0.0) {
        // In steps of the smallest bricks, so that neighbours agree on what they share.
        uvec3 name = kOrderSteps * brick.cell + (orderNodePlace(thread) << brick.scale);
        Vec4Array(ordersTable.nodes).at[node] = vec4(gatherAt(place.xyz, name).fluence, 1.0);
    }
}
