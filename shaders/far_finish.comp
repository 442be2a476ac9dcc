// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the nodes that frames read from the sums. A node in a solid belongs to the air
// beside it: its value goes on from there in a straight line, so that the field is
// as good up to the wall as in the open.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "far_bake.glsl"

layout(local_size_x = kGroupSize) in;

layout(constant_id = NIGHTCITY_CONSTANT_FAR_MEAN) const uint kKeepMean = 1u;

const float kLargestHalf = 65504.0;

bool isSolid(uint brick, uint node) {
    return (UintArray(bakeTable.sides).at[brick * kBrickSideWords + (node >> 5)] >> (node & 31u) &
            1u) != 0u;
}

// Sum of a node in the air, W m^-2; `found` is false in a solid and where no node is. `place`: in
// node spacings of scale 0 from the lattice's corner.
vec3 airNode(FarFieldTable field, ivec3 place, out bool found) {
    ivec3 counts = ivec3(field.cellCounts);
    found = false;
    // A node on a face belongs to two bricks, on an edge to four; some may not be there.
    for (int i = 0; i < 8; ++i) {
        ivec3 back = ivec3(i, i >> 1, i >> 2) & 1;
        uint index = brickAt(field, (place - back) >> 3);
        if (index == kNone) {
            continue;
        }
        FarBrick brick = FarBrickArray(field.bricks).at[index];
        ivec3 at = place - 8 * ivec3(brick.cell);
        ivec3 steps = at >> brick.scale;
        if (steps << brick.scale == at && all(lessThanEqual(steps, ivec3(8)))) {
            uint node = nodeAt(uvec3(steps));
            found = !isSolid(index, node);
            if (found) {
                return vec3(Uvec3Array(bakeTable.sums).at[index * kBrickNodes + node]) *
                       FloatArray(bakeTable.units).at[index];
            }
        }
    }
    return vec3(0.0);
}

// Second difference along an axis; beyond a wall it goes on as before it. 0 where too few nodes
// are in the air.
vec3 bendAlong(FarFieldTable field, ivec3 place, ivec3 way, vec3 value) {
    bool isBefore, isAfter, isNext;
    vec3 before = airNode(field, place - way, isBefore);
    vec3 after = airNode(field, place + way, isAfter);
    if (isBefore && isAfter) {
        return before - 2.0 * value + after;
    }
    if (!isBefore && !isAfter) {
        return vec3(0.0);
    }
    vec3 next = airNode(field, place + (isAfter ? 2 : -2) * way, isNext);
    return isNext ? value - 2.0 * (isAfter ? after : before) + next : vec3(0.0);
}

// Straight interpolation between the values of a curved function is off by 1 / 12 of its second
// difference in the mean over a cell, and so along rays; between these it is not (Condat,
// Blu and Unser 2005, Beyond interpolation: optimal reconstruction by quasi-interpolation).
vec3 keptInTheMean(FarFieldTable field, ivec3 place, uint scale, vec3 value) {
    if (kKeepMean == 0u) {
        return value;
    }
    vec3 bend = bendAlong(field, place, ivec3(1, 0, 0) << scale, value) +
                bendAlong(field, place, ivec3(0, 1, 0) << scale, value) +
                bendAlong(field, place, ivec3(0, 0, 1) << scale, value);
    return max(value - bend / 12.0, vec3(0.0));
}

// From the two nodes that follow in a direction; 0 and false where the first is no air.
vec3 goingOn(FarFieldTable field, ivec3 place, ivec3 way, out bool found) {
    vec3 first = airNode(field, place + way, found);
    if (!found) {
        return vec3(0.0);
    }
    bool foundSecond;
    vec3 second = airNode(field, place + 2 * way, foundSecond);
    return foundSecond ? max(2.0 * first - second, vec3(0.0)) : first;
}

// The mean over the nearest neighbours in the air: along axes, else in planes, else in space.
vec3 fromTheAir(FarFieldTable field, ivec3 place, uint scale) {
    for (int axes = 1; axes <= 3; ++axes) {
        vec3 sum = vec3(0.0);
        float count = 0.0;
        for (int i = 0; i < 27; ++i) {
            ivec3 way = ivec3(i % 3, i / 3 % 3, i / 9) - 1;
            ivec3 size = abs(way);
            if (size.x + size.y + size.z == axes) {
                bool found;
                sum += goingOn(field, place, way << scale, found);
                count += found ? 1.0 : 0.0;
            }
        }
        if (count > 0.0) {
            return sum / count;
        }
    }
    return vec3(0.0);
}

void main() {
    FarFieldTable field = bakedField;
    uint index = groupBrick();
    FarBrick brick = FarBrickArray(field.bricks).at[index];
    ivec3 first = 8 * ivec3(brick.cell);
    uint firstNode = index * kBrickNodes;
    float unit = FloatArray(bakeTable.units).at[index];
    for (uint node = gl_LocalInvocationIndex; node < kBrickNodes; node += kGroupSize) {
        ivec3 place = first + ivec3(nodePlace(node) << brick.scale);
        vec3 sum = vec3(Uvec3Array(bakeTable.sums).at[firstNode + node]);
        vec3 value = isSolid(index, node)
                         ? fromTheAir(field, place, brick.scale)
                         : keptInTheMean(field, place, brick.scale, sum * unit);
        value = min(value / field.nodeUnit, vec3(kLargestHalf));
        FarNodeArray(field.nodes).at[firstNode + node] =
            uvec2(packHalf2x16(value.xy), packHalf2x16(vec2(value.z, 0.0)));
    }
}
