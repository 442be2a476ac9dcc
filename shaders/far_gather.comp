// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The next order of scattering in the cells: the mean over their places.
#version 460
#extension GL_GOOGLE_include_directive : require

// As path.comp: glslang 12 crashes while it spreads `precise` through this program.
#define precise
#define NIGHTCITY_KEEP_TABLES
#include "order_rays.glsl"

layout(local_size_x = kPlaceThreads) in;

shared vec3 fluences[kPlaceThreads];
shared vec3 irradiances[kPlaceThreads * kCellSides];
shared uint places[kPlaceThreads];  // 1 where there is one

void keep(uint thread, Gathered gathered) {
    fluences[thread] = gathered.fluence;
    for (uint side = 0u; kLit != 0u && side < kCellSides; ++side) {
        irradiances[kCellSides * thread + side] = gathered.sides[side];
    }
}

// The mean over the places of each cell.
void finishCell(uint cell, uint first) {
    float share = 0.0;
    vec3 fluence = vec3(0.0);
    for (uint i = first; i < first + kCellPlaces; ++i) {
        fluence += fluences[i];
        share += float(places[i]);
    }
    share = 1.0 / max(share, 1.0);
    Vec3Array(cellsOfOrder(push.round)).at[cell] = share * fluence;
    Vec3Array(ordersTable.higher).at[cell] += share * fluence;
    for (uint side = 0u; kLit != 0u && side < kCellSides; ++side) {
        vec3 irradiance = vec3(0.0);
        for (uint i = first; i < first + kCellPlaces; ++i) {
            irradiance += irradiances[kCellSides * i + side];
        }
        Vec3Array(sidesOfOrder(push.round)).at[kCellSides * cell + side] = share * irradiance;
        Vec3Array(ordersTable.higherSides).at[kCellSides * cell + side] += share * irradiance;
    }
}

void main() {
    keepOrdersTables();
    uint thread = gl_LocalInvocationIndex;
    uint number = orderBrick() * kPlaceThreads + thread;
    vec4 place = Vec4Array(ordersTable.places).at[number];
    Gathered gathered;
    gathered.fluence = vec3(0.0);
    for (uint side = 0u; side < kCellSides; ++side) {
        gathered.sides[side] = vec3(0.0);
    }
    if (place.w > 0.0) {
        gathered = gatherAt(place.xyz, uvec3(number, 0u, 0u));
    }
    places[thread] = place.w > 0.0 ? 1u : 0u;
    keep(thread, gathered);
    barrier();
    if (thread < kOrderCells) {
        finishCell(orderBrick() * kOrderCells + thread, thread * kCellPlaces);
    }
}
