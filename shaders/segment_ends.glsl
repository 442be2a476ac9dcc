// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The ends of a segment about its box's corner, precisely: boxInterval says
// whether a face, the camera or a surface ends it; where the ray meets the
// plane is found again in two floats. Neighbours that share a face find the
// same end.
#ifndef NIGHTCITY_SHADERS_SEGMENT_ENDS_GLSL
#define NIGHTCITY_SHADERS_SEGMENT_ENDS_GLSL

#include "box_interval.glsl"
#include "camera_ray.glsl"
#include "primitives.glsl"

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

// Where the ray meets the surface that float found at `depth`.
TwoFloat surfaceDepth(PreciseRay ray, uint primitive, float depth) {
    vec3 point, normal;
    planeOf(primitive, point, normal);
    TwoFloat distance = TwoFloat(0.0, 0.0);
    TwoFloat speed = TwoFloat(0.0, 0.0);
    for (int axis = 0; axis < 3; ++axis) {
        TwoFloat component = TwoFloat(normal[axis], 0.0);
        TwoFloat toPoint = subtract(TwoFloat(point[axis], 0.0), ray.origin[axis]);
        distance = add(distance, multiply(toPoint, component));
        speed = add(speed, multiply(ray.direction[axis], component));
    }
    TwoFloat precisely = divide(distance, speed);
    // Along the surface the quotient is worthless, and no better than what was found.
    return abs(precisely.hi - depth) <= 1e-3 * depth ? precisely : TwoFloat(depth, 0.0);
}

// entry and exit come from boxInterval with the surface's depth as the end.
Segment segmentBetween(PreciseRay ray, vec3 lo, vec3 hi, uint box, float entry, float exit,
                       SurfaceRecord surface) {
    TwoFloat begin = TwoFloat(0.0, 0.0);  // the camera is inside
    if (entry > 0.0) {
        begin = boundaryDepth(ray, lo, hi, true);
    }
    TwoFloat end = exit == surface.depth ? surfaceDepth(ray, surface.primitive, exit)
                                         : boundaryDepth(ray, lo, hi, false);
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
