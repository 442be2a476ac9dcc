// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The ends of a segment about its box's corner, precisely: which plane ends it
// is known from boxInterval; where the ray meets that plane is found again in
// two floats. Neighbours that share a plane find the same end.
#ifndef NIGHTCITY_SHADERS_SEGMENT_ENDS_GLSL
#define NIGHTCITY_SHADERS_SEGMENT_ENDS_GLSL

#include "box_interval.glsl"
#include "camera_ray.glsl"

TwoFloat planeDepth(PreciseRay ray, int axis, float plane) {
    return divide(subtract(TwoFloat(plane, 0.0), ray.origin[axis]), ray.direction[axis]);
}

// Of the planes entered (or left), the one met last (first).
TwoFloat boundaryDepth(PreciseRay ray, vec3 lo, vec3 hi, bool entering) {
    TwoFloat best = TwoFloat(entering ? 0.0 : 1e30, 0.0);
    for (int axis = 0; axis < 3; ++axis) {
        float direction = ray.direction[axis].hi;
        if (abs(direction) >= kSmallestDirection) {
            float plane = (direction > 0.0) == entering ? lo[axis] : hi[axis];
            TwoFloat depth = planeDepth(ray, axis, plane);
            TwoFloat difference = subtract(depth, best);
            if (entering == (difference.hi > 0.0)) {
                best = depth;
            }
        }
    }
    return best;
}

TwoFloat pointAt(PreciseRay ray, int axis, float corner, TwoFloat depth) {
    TwoFloat fromCorner = subtract(ray.origin[axis], TwoFloat(corner, 0.0));
    return add(fromCorner, multiply(ray.direction[axis], depth));
}

// entry and exit come from boxInterval: entry 0 is the camera inside the box, an
// exit before the box's own is a surface.
Segment segmentBetween(PreciseRay ray, vec3 lo, vec3 hi, uint box, float entry, float exit) {
    TwoFloat begin = TwoFloat(0.0, 0.0);
    if (entry > 0.0) {
        begin = boundaryDepth(ray, lo, hi, true);
    }
    TwoFloat end = boundaryDepth(ray, lo, hi, false);
    // A surface ends it where it lies before the box's end by more than rounding.
    if (exit < end.hi * (1.0 - 1e-6)) {
        end = TwoFloat(exit, 0.0);
    }
    float depths = max(toFloat(subtract(end, begin)), 0.0);
    Segment segment;
    segment.box = box;
    for (int axis = 0; axis < 3; ++axis) {
        segment.start[axis] = toFloat(pointAt(ray, axis, lo[axis], begin));
        segment.span[axis] = toFloat(ray.direction[axis]) * depths;
    }
    return segment;
}

#endif
