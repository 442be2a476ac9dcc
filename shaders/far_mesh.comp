// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which points of a brick's mesh see the lights of its entries whose sight is that of the mesh
// (far_mesh.glsl): one way each, from another part of the light than its neighbours'.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "far_hiding.glsl"
#include "far_window.glsl"

layout(local_size_x = kGroupSize) in;

// Whether a place is behind all panes of a light.
bool isBehind(FarLight light, vec3 way) {
    float coneSin = sqrt(max(1.0 - light.coneCos * light.coneCos, 0.0));
    return light.coneCos >= 0.0 && dot(light.axis, way) <= -coneSin * length(way);
}

bool sees(vec3 place, uvec3 point, FarLight light, uint index, FarWindow window, vec3 origin) {
    if (isBehind(light, place - window.centre)) {
        return false;
    }
    uvec3 parity = point & 1u;
    vec3 part = light.second == 0u
                    ? panePoint(window, parity.x | (parity.y ^ parity.z) << 1)
                    : partOf(index, parity.x | parity.y << 1 | parity.z << 2) - origin;
    bool isBelow = sceneTable.groundMaterial != kNone &&
                   origin.z + part.z < sceneTable.groundHeight;
    return !isBelow && !isHiddenByAny(part, place, origin);
}

uint layerSees(uint entry, uint layer, FarBrick brick, float side, vec3 origin) {
    uint index = FarEntryArray(bakeTable.entries).at[entry].light;
    FarLight light = FarLightArray(bakeTable.lights).at[index];
    FarWindow window = farWindow(entry, origin);
    uint word = 0u;
    for (uint i = 0u; i < kMeshSide * kMeshSide; ++i) {
        uvec3 point = uvec3(i % kMeshSide, i / kMeshSide, layer);
        vec3 place = (vec3(point) / float(kMeshSide - 1u) - 0.5) * side;
        // Neighbouring bricks agree on what they share.
        uvec3 number = (brick.cell >> brick.scale) * (kMeshSide - 1u) + point;
        word |= sees(place, number, light, index, window, origin) ? 1u << i : 0u;
    }
    return word;
}

void main() {
    FarFieldTable field = bakedField;
    FarBrick brick = FarBrickArray(field.bricks).at[groupBrick()];
    float side = brickSide(field, brick);
    vec3 origin = brickCorner(field, brick) + 0.5 * side;
    uint firstEntry = groupInBatch() * bakeTable.entryCapacity;
    uint entries = UintArray(bakeTable.entryCounts).at[groupInBatch()];
    for (uint i = gl_LocalInvocationIndex; i < entries * kMeshSide; i += kGroupSize) {
        uint entry = firstEntry + i / kMeshSide;
        if (FarEntryArray(bakeTable.entries).at[entry].faceCount == kMesh) {
            uint layer = i % kMeshSide;
            FarEntryArray(bakeTable.entries).at[entry].face[layer] =
                layerSees(entry, layer, brick, side, origin);
        }
    }
}
