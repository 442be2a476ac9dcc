// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The haze on a ray, part by part in the order in which the ray meets it: down the tree of
// planes from the lowest node that holds all that is left of the ray, again for each cell
// (Foley and Sugerman 2005, KD-tree acceleration structures for a GPU raytracer: restart,
// with push-down), so that no stack can overflow.
#ifndef NIGHTCITY_SHADERS_HAZE_WALK_GLSL
#define NIGHTCITY_SHADERS_HAZE_WALK_GLSL

#include "box_interval.glsl"
#include "camera_ray.glsl"
#include "far_field.h"

NIGHTCITY_ARRAY(HazeArray, FarMedium)

struct HazeWalk {
    uvec2 nodes;     // HazeNode, the tree; 0: no haze
    vec3 origin;
    vec3 direction;  // unit vector
    vec3 inverse;
    float at;        // m: all before is known
    float end;
    uint root;       // holds all that is left
};

// A part of a ray in haze.
struct HazePart {
    float entry;   // m
    float exit;    // m
    uint medium;   // into FarMedium; kNone: there is none left
};

HazeWalk walkOf(uvec2 nodes, Ray ray, float end) {
    float last = nodes == uvec2(0) ? 0.0 : end;
    return HazeWalk(nodes, ray.origin, ray.direction, reciprocal(ray.direction), 0.0, last, 0u);
}

HazeWalk hazeWalk(Ray ray, float end) {
    return walkOf(sceneTable.hazeNodes, ray, end);
}

// A leaf, and what it may hold.
struct HazeLeaf {
    uint node;
    uint item;
};

// The leaf about `at`, and in `cellEnd` where the ray leaves it.
HazeLeaf leafAt(inout HazeWalk walk, out float cellEnd) {
    HazeNodeArray nodes = HazeNodeArray(walk.nodes);
    cellEnd = walk.end;
    uint index = walk.root;
    bool isWhole = true;  // all that is left lies in the node
    HazeNode node = nodes.at[index];
    while (node.axis != kHazeLeaf) {
        float from = node.plane - walk.origin[node.axis];
        float way = walk.direction[node.axis];
        bool isLevel = abs(way) < kSmallestDirection;
        precise float crossing = from * walk.inverse[node.axis];
        bool startsBelow = isLevel ? from > 0.0 : way > 0.0;
        bool isPast = !isLevel && crossing <= walk.at;
        bool isBefore = isLevel || isPast || crossing >= cellEnd;
        bool below = isPast ? !startsBelow : startsBelow;
        cellEnd = isBefore ? cellEnd : crossing;
        index = below ? index + 1u : node.item;
        isWhole = isWhole && isBefore;
        walk.root = isWhole ? index : walk.root;
        node = nodes.at[index];
    }
    return HazeLeaf(index, node.item);
}

HazePart nextHaze(inout HazeWalk walk) {
    while (walk.at < walk.end) {
        float cellEnd;
        uint medium = leafAt(walk, cellEnd).item;
        float begin = walk.at;
        walk.at = cellEnd;
        if (medium != kNone) {
            FarMedium haze = HazeArray(sceneTable.haze).at[medium];
            float entry, exit;
            boxInterval(walk.origin, walk.direction, walk.inverse, haze.lo, haze.hi, cellEnd,
                        entry, exit);
            entry = max(entry, begin);
            if (entry < exit) {
                return HazePart(entry, exit, medium);
            }
        }
    }
    return HazePart(0.0, 0.0, kNone);
}

// All haze on a ray up to its surface.
struct HazeSpan {
    float begin;  // m
    float end;    // m; not after begin where there is no haze
    float depth;  // optical
};

HazeSpan hazeSpan(Ray ray, float end) {
    HazeSpan span = HazeSpan(1e10, 0.0, 0.0);
    HazeWalk walk = hazeWalk(ray, end);
    for (HazePart part = nextHaze(walk); part.medium != kNone; part = nextHaze(walk)) {
        span.begin = min(span.begin, part.entry);
        span.end = part.exit;
        span.depth +=
            HazeArray(sceneTable.haze).at[part.medium].extinction * (part.exit - part.entry);
    }
    return span;
}

// A point on a ray in haze.
struct HazePoint {
    float distance;    // m along the ray
    float depth;       // optical depth up to it
    float extinction;  // 1/m; 0 in clear air
    float scattering;  // 1/m
};

// The point `distance` m along a ray.
HazePoint hazeAtDistance(Ray ray, float distance) {
    HazePoint point = HazePoint(distance, 0.0, 0.0, 0.0);
    HazeWalk walk = hazeWalk(ray, distance);
    for (HazePart part = nextHaze(walk); part.medium != kNone; part = nextHaze(walk)) {
        FarMedium haze = HazeArray(sceneTable.haze).at[part.medium];
        point.depth += haze.extinction * (part.exit - part.entry);
        if (part.exit == distance) {
            point.extinction = haze.extinction;
            point.scattering = haze.scattering;
        }
    }
    return point;
}

// The point at an optical depth, which must be less than that of [0, end).
HazePoint hazeAtDepth(Ray ray, float end, float depth) {
    HazePoint point = HazePoint(0.0, 0.0, 0.0, 0.0);
    HazeWalk walk = hazeWalk(ray, end);
    for (HazePart part = nextHaze(walk); part.medium != kNone; part = nextHaze(walk)) {
        FarMedium haze = HazeArray(sceneTable.haze).at[part.medium];
        float whole = haze.extinction * (part.exit - part.entry);
        float within = max(depth - point.depth, 0.0) / haze.extinction;
        bool isHere = point.depth + whole >= depth;
        // The last part takes what rounding carries beyond it.
        point = HazePoint(isHere ? min(part.entry + within, part.exit) : part.exit,
                          isHere ? depth : point.depth + whole, haze.extinction, haze.scattering);
        if (isHere) {
            break;
        }
    }
    return point;
}

#endif
