// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds the light of higher orders to the nodes that frames read, interpolated between the nodes of
// higher orders that are in no solid.
#version 460
#extension GL_GOOGLE_include_directive : require

#define NIGHTCITY_KEEP_TABLES
#include "order_cells.glsl"

layout(local_size_x = kGroupSize) in;

// Share of higher orders that a node may be off by; as measured in the paper's city.
const float kErrorOfOrders = 0.06;

// What a node counts whose share is 0: where it alone is in the air, it speaks for the others.
const float kLeastShare = 1e-4;

// W m^-2; `at`: the node in its brick, of the far field.
vec3 higherOrders(uint brick, uvec3 at) {
    vec3 grid = 0.5 * vec3(at);
    uvec3 corner = min(at / 2u, uvec3(kOrderSteps - 1u));
    vec3 t = grid - vec3(corner);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (uint i = 0u; i < 8u; ++i) {
        vec3 shares = mix(1.0 - t, t, vec3(cornerOf(i)));
        uvec3 place = corner + cornerOf(i);
        uint node =
            brick * kOrderNodes + (place.z * kOrderSide + place.y) * kOrderSide + place.x;
        vec4 value = Vec4Array(ordersTable.nodes).at[node];
        float weight = (shares.x * shares.y * shares.z + kLeastShare) * value.w;
        sum += weight * value.rgb;
        weights += weight;
    }
    return weights > 0.0 ? sum / weights : vec3(0.0);
}

void main() {
    keepOrdersTables();
    FarFieldTable field = ordersField;
    uint index = orderBrick();
    const uint side = kBrickSteps + 1u;
    for (uint node = gl_LocalInvocationIndex; node < kBrickNodes; node += kGroupSize) {
        uvec3 at = uvec3(node, node / side, node / (side * side)) % side;
        vec3 higher = higherOrders(index, at);
        vec4 value = farNode(field, index * kBrickNodes + node) * field.nodeUnit;
        float largest = max(higher.r, max(higher.g, higher.b));
        value = (value + vec4(higher, kErrorOfOrders * largest)) / field.nodeUnit;
        value = min(value, vec4(kLargestHalf));
        FarNodeArray(field.nodes).at[index * kBrickNodes + node] =
            uvec2(packHalf2x16(value.xy), packHalf2x16(value.zw));
    }
}
