// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the nodes that frames read from the sums. A node in a solid belongs to the air
// beside it: its value goes on from there in a straight line, so that the field is
// as good up to the wall as in the open.
#version 460
#extension GL_GOOGLE_include_directive : require

#define NIGHTCITY_KEEP_TABLES
#include "far_bake.glsl"

layout(local_size_x = kGroupSize) in;

layout(constant_id = NIGHTCITY_CONSTANT_FAR_MEAN) const uint kKeepMean = 1u;

// Shares of differences between nodes that straight interpolation may be off. A parabola is off by
// 1 / 12 of its second difference at nodes and 1 / 24 between them; where shadows begin it is
// more, and the fourth difference tells; at walls, where there is none, the second stands for it.
// And of the value: panes are seen by quarters, and halves are rounded. Chosen so that 99 of
// 100 places of the paper's city lie within their sum (far_field_test.cpp).
const float kErrorOfSecond = 0.06;
const float kErrorOfFourth = 0.12;
const float kErrorAtWalls = 0.25;
const float kErrorOfValue = 5e-4;

// Sum of a node in the air, W m^-2; `found` is false in a solid and where no node is. `place`: in
// node spacings of scale 0 from the lattice's corner.
vec3 airNode(FarFieldTable field, ivec3 place, out bool found) {
    found = false;
    // A node on a face belongs to two bricks, on an edge to four; some may not be there. The loop
    // goes through the subsets of the axes along which the place is between two cells.
    uvec3 between = uvec3(equal(place & 7, ivec3(0))) << uvec3(0u, 1u, 2u);
    uint axes = between.x | between.y | between.z;
    uint i = 0u;
    do {
        ivec3 back = ivec3(i, i >> 1, i >> 2) & 1;
        uint index = brickAt(field, (place - back) >> 3);
        FarBrick brick = FarBrickArray(field.bricks).at[index == kNone ? 0u : index];
        ivec3 at = place - 8 * ivec3(brick.cell);
        ivec3 steps = at >> brick.scale;
        if (index != kNone && steps << brick.scale == at && all(lessThanEqual(steps, ivec3(8)))) {
            uint node = nodeAt(uvec3(steps));
            if (!isSolid(index, node)) {
                found = true;
                return vec3(Uvec3Array(bakeTable.sums).at[index * kBrickNodes + node]) *
                       FloatArray(bakeTable.units).at[index];
            }
        }
        i = (i - axes) & axes;
    } while (i != 0u);
    return vec3(0.0);
}

// Along an axis: the second difference, and how far interpolation may be off.
struct Bend {
    vec3 second;
    vec3 error;
};

// Beyond a wall it goes on as before it; 0 where too few nodes are in the air.
Bend bendAlong(FarFieldTable field, ivec3 place, ivec3 way, vec3 value) {
    bool isBefore, isAfter, isFirst, isLast;
    vec3 before = airNode(field, place - way, isBefore);
    vec3 after = airNode(field, place + way, isAfter);
    vec3 first = airNode(field, place - 2 * way, isFirst);
    vec3 last = airNode(field, place + 2 * way, isLast);
    if (isBefore && isAfter) {
        vec3 second = before - 2.0 * value + after;
        vec3 error = isFirst && isLast
                         ? kErrorOfSecond * abs(second) +
                               kErrorOfFourth * abs(first + last - 4.0 * second - 2.0 * value)
                         : kErrorAtWalls * abs(second);
        return Bend(second, error);
    }
    vec3 second = isAfter && isLast      ? value - 2.0 * after + last
                  : isBefore && isFirst ? value - 2.0 * before + first
                                        : vec3(0.0);
    return Bend(second, kErrorAtWalls * abs(second));
}

// What a frame reads of a node, W m^-2.
struct NodeValue {
    vec3 fluence;
    float error;  // estimate, of the largest channel: of what is interpolated around the node
};

float largestOf(vec3 value) {
    return max(value.r, max(value.g, value.b));
}

// Straight interpolation between the values of a curved function is off by 1 / 12 of its second
// difference in the mean over a cell, and so along rays; between these it is not (Condat,
// Blu and Unser 2005, Beyond interpolation: optimal reconstruction by quasi-interpolation).
NodeValue keptInTheMean(FarFieldTable field, ivec3 place, uint scale, vec3 value) {
    vec3 bend = vec3(0.0);
    vec3 error = kErrorOfValue * value;
    for (int axis = 0; axis < 3; ++axis) {
        ivec3 way = ivec3(equal(ivec3(axis), ivec3(0, 1, 2))) << scale;
        Bend along = bendAlong(field, place, way, value);
        bend += along.second;
        error += along.error;
    }
    vec3 kept = kKeepMean == 0u ? value : max(value - bend / 12.0, vec3(0.0));
    return NodeValue(kept, largestOf(error));
}

// From the two nodes that follow in a direction; 0 where the first, which is given too, is no air.
// Below 0 only as far as straight interpolation reaches 0 in the middle.
vec3 goingOn(FarFieldTable field, ivec3 place, ivec3 way, out vec3 first, out bool found) {
    first = airNode(field, place + way, found);
    if (!found) {
        return vec3(0.0);
    }
    bool foundSecond;
    vec3 second = airNode(field, place + 2 * way, foundSecond);
    return foundSecond ? max(2.0 * first - second, -first) : first;
}

const int kWays = 27;  // to the nodes around one, and to itself

ivec3 wayOf(int number) {
    return ivec3(number % 3, number / 3 % 3, number / 9) - 1;
}

// From `number` on the next way along as many axes; kWays: none. A loop of its own, so that all
// threads then look along one.
int nextWay(int number, int axes) {
    ivec3 size = abs(wayOf(number));
    while (number < kWays && size.x + size.y + size.z != axes) {
        size = abs(wayOf(++number));
    }
    return number;
}

// The mean over the nearest neighbours in the air: along axes, else in planes, else in space. The
// error is that of a straight line whose slope may be wrong by as much as it is.
NodeValue fromTheAir(FarFieldTable field, ivec3 place, uint scale) {
    for (int axes = 1; axes <= 3; ++axes) {
        vec3 sum = vec3(0.0);
        vec3 firsts = vec3(0.0);
        float count = 0.0;
        for (int i = nextWay(0, axes); i < kWays; i = nextWay(i + 1, axes)) {
            bool found;
            vec3 first;
            sum += goingOn(field, place, wayOf(i) << scale, first, found);
            firsts += first;
            count += found ? 1.0 : 0.0;
        }
        if (count > 0.0) {
            return NodeValue(sum / count, 0.5 * largestOf(abs(sum - firsts)) / count);
        }
    }
    return NodeValue(vec3(0.0), 0.0);
}

void main() {
    keepBakeTables();
    FarFieldTable field = bakedField;
    uint index = groupBrick();
    FarBrick brick = FarBrickArray(field.bricks).at[index];
    ivec3 first = 8 * ivec3(brick.cell);
    uint firstNode = index * kBrickNodes;
    float unit = FloatArray(bakeTable.units).at[index];
    for (uint node = gl_LocalInvocationIndex; node < kBrickNodes; node += kGroupSize) {
        ivec3 place = first + ivec3(nodePlace(node) << brick.scale);
        vec3 sum = vec3(Uvec3Array(bakeTable.sums).at[firstNode + node]);
        NodeValue value = isSolid(index, node)
                              ? fromTheAir(field, place, brick.scale)
                              : keptInTheMean(field, place, brick.scale, sum * unit);
        vec4 packed = min(vec4(value.fluence, value.error) / field.nodeUnit, vec4(kLargestHalf));
        FarNodeArray(field.nodes).at[firstNode + node] =
            uvec2(packHalf2x16(packed.xy), packHalf2x16(packed.zw));
    }
}
