// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Places in the haze of each cell, and the mean fluence there that comes straight from the windows:
// what the nodes hold, and of near windows what they do not.
#version 460
#extension GL_GOOGLE_include_directive : require

#define NIGHTCITY_KEEP_TABLES
#include "order_cells.glsl"
#include "far_places.glsl"
#include "transport/random.h"

layout(local_size_x = kPlaceThreads) in;

shared vec3 fluences[kPlaceThreads];
shared uint inHaze[kPlaceThreads];  // trials

// The first trial in the haze of a cell, and how many are.
vec4 findPlace(vec3 corner, float side, uint seed, out uint found) {
    vec4 place = vec4(0.0);
    found = 0u;
    for (uint trial = 0u; trial < kPlaceTrials; ++trial) {
        uvec4 bits = pcg4d(uvec4(seed, trial, 0u, 0u));
        vec3 at = corner + side * vec3(unitFloat(bits.x), unitFloat(bits.y), unitFloat(bits.z));
        if (isInHaze(at, bakedField) && !isInSolid(at)) {
            place = found == 0u ? vec4(at, 1.0) : place;
            ++found;
        }
    }
    return place;
}

void main() {
    keepOrdersTables();
    bakeTable = FarBakeReference(ordersTable.bake).table;
    bakedField = ordersField;
    uint index = orderBrick();
    FarBrick brick = FarBrickArray(ordersField.bricks).at[index];
    vec3 corner = brickCorner(ordersField, brick);
    float brickSide = brickSide(ordersField, brick);
    float side = cellSideOf(ordersField, brick.scale);
    uint thread = gl_LocalInvocationIndex;
    uint number = index * kPlaceThreads + thread;
    uint found;
    vec3 cellCorner = corner + side * vec3(orderCellPlace(thread / kCellPlaces));
    vec4 place = findPlace(cellCorner, side, number, found);
    fluences[thread] = vec3(0.0);
    if (found > 0u) {
        fluences[thread] = farSample(ordersField, index, (place.xyz - corner) / brickSide).rgb;
    }
    inHaze[thread] = found;
    Vec4Array(ordersTable.places).at[number] = place;
    barrier();
    if (thread < kOrderCells) {
        vec3 sum = vec3(0.0);
        uint places = 0u;
        uint trials = 0u;
        for (uint i = thread * kCellPlaces; i < (thread + 1u) * kCellPlaces; ++i) {
            sum += fluences[i];
            places += inHaze[i] > 0u ? 1u : 0u;
            trials += inHaze[i];
        }
        uint cell = index * kOrderCells + thread;
        float volume = side * side * side * float(trials) / float(kCellPlaces * kPlaceTrials);
        vec3 near = ordersTable.energyUnit * vec3(Uvec3Array(ordersTable.nearEnergy).at[cell]);
        FloatArray(ordersTable.hazeVolume).at[cell] = volume;
        Vec3Array(cellsOfOrder(1u)).at[cell] =
            places > 0u ? sum / float(places) + near / volume : vec3(0.0);
        Vec3Array(ordersTable.higher).at[cell] = vec3(0.0);
        for (uint side = 0u; side < kCellSides && ordersTable.higherSides != uvec2(0); ++side) {
            Vec3Array(ordersTable.higherSides).at[kCellSides * cell + side] = vec3(0.0);
        }
    }
}
