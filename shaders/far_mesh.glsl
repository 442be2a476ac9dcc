// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Sight of lights with more faces before them than an entry lists: known at every other node of a brick along each axis, and between these the mean of
// those around that lie in the air.
#ifndef NIGHTCITY_SHADERS_FAR_MESH_GLSL
#define NIGHTCITY_SHADERS_FAR_MESH_GLSL

#extension GL_EXT_control_flow_attributes : require

#include "far_bake.glsl"

const float kSolidWeight = 1e-3;  // of points in a solid, which count only where there are no others

// Of an upright column of nodes, in each layer of the mesh.
struct MeshColumn {
    uvec4 around;            // bits of the four points about it; some are one where it runs
                             // through them
    vec4 weight[kMeshSide];
    float perWeight[kBrickSide];  // of each node: 1 / the sum of those about it
};

// Bits of a layer's word: which points see the light.
struct MeshSight {
    float seen[kMeshSide];  // sum of the weights of those that do
};

bool isSolidPoint(uint point, uint layer) {
    return isSolid(groupBrick(),
                   nodeAt(2u * uvec3(point % kMeshSide, point / kMeshSide, layer)));
}

float meshWeight(uint point, uint layer) {
    return isSolidPoint(point, layer) ? kSolidWeight : 1.0;
}

// `column`: number of its foot among the nodes.
MeshColumn meshColumn(uint column) {
    uvec2 place = nodePlace(column).xy;
    uvec2 low = place / 2u;
    uvec2 high = (place + 1u) / 2u;
    MeshColumn found;
    found.around = uvec4(low.y, low.y, high.y, high.y) * kMeshSide +
                   uvec4(low.x, high.x, low.x, high.x);
    [[unroll]] for (uint layer = 0u; layer < kMeshSide; ++layer) {
        [[unroll]] for (uint i = 0u; i < 4u; ++i) {
            found.weight[layer][i] = meshWeight(found.around[i], layer);
        }
    }
    [[unroll]] for (uint i = 0u; i < kBrickSide; ++i) {
        vec4 weights = found.weight[i / 2u] + found.weight[(i + 1u) / 2u];
        found.perWeight[i] = 1.0 / dot(weights, vec4(1.0));
    }
    return found;
}

// `words`: of the entry, one a layer.
MeshSight meshSight(uint words[kMeshSide], MeshColumn column) {
    MeshSight sight;
    [[unroll]] for (uint layer = 0u; layer < kMeshSide; ++layer) {
        uint word = words[layer];
        vec4 sees = vec4((uvec4(word) >> column.around) & 1u);
        sight.seen[layer] = dot(sees, column.weight[layer]);
    }
    return sight;
}

// From node i of the column.
float meshShare(MeshSight sight, MeshColumn column, uint i) {
    return (sight.seen[i / 2u] + sight.seen[(i + 1u) / 2u]) * column.perWeight[i];
}

#endif
