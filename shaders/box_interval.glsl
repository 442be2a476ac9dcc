// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a ray is inside a media box: lo <= x < hi in each axis. Binding-free.
#ifndef NIGHTCITY_SHADERS_BOX_INTERVAL_GLSL
#define NIGHTCITY_SHADERS_BOX_INTERVAL_GLSL

// Below this a direction component is zero, and the rule itself decides: its
// reciprocal would overflow. Directions are of length 1 and more.
const float kSmallestDirection = 1e-30;

// The reciprocal is taken once a ray, so that a plane shared by two boxes gives
// both the same parameter to the bit, and later planes never a smaller one.
vec3 reciprocal(vec3 direction) {
    return 1.0 / mix(direction, vec3(1.0), lessThan(abs(direction), vec3(kSmallestDirection)));
}

// The part of [0, end) inside the box as [entry, exit); empty where entry >= exit.
void boxInterval(vec3 origin, vec3 direction, vec3 inverse, vec3 lo, vec3 hi, float end,
                 out float entry, out float exit) {
    entry = 0.0;
    exit = end;
    for (int axis = 0; axis < 3; ++axis) {
        precise float toLo = (lo[axis] - origin[axis]) * inverse[axis];
        precise float toHi = (hi[axis] - origin[axis]) * inverse[axis];
        if (abs(direction[axis]) < kSmallestDirection) {
            bool inside = lo[axis] <= origin[axis] && origin[axis] < hi[axis];
            toLo = inside ? 0.0 : end;
            toHi = inside ? end : 0.0;
            // An empty interval stays empty under min and max only if both ends move.
            entry = max(entry, toLo);
            exit = min(exit, toHi);
        } else {
            entry = max(entry, min(toLo, toHi));
            exit = min(exit, max(toLo, toHi));
        }
    }
}

#endif
