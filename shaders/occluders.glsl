// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which opaque faces may lie between two things: from a point, a ball or a box to a
// straight stretch or a box. Asked once for a stretch, a facade or a brick of grid nodes,
// the answer serves for everything inside them. The ground is no face: it hides what
// lies on the other side of its height.
//
//     Between between = betweenBoxAndStretch(origin, half, begin, end);
//     uint walk = 0u;
//     for (uint face = nextOccluder(walk, between); face != kNone;
//          face = nextOccluder(walk, between)) { ... }
//
// `origin` is any point that float holds as the scene does (a window's centre, a corner of
// a media box); all else is relative to it, so that 10 km from the scene's origin
// nothing is lost. Faces come in the order of the tree, and none that touches is left out.
#ifndef NIGHTCITY_SHADERS_OCCLUDERS_GLSL
#define NIGHTCITY_SHADERS_OCCLUDERS_GLSL

#include "addresses.glsl"

// m: more than float loses in distances of up to a kilometre.
const float kBetweenSlack = 2e-4;
const float kBetweenShare = 4e-6;  // the same as a share of the way

// The hull of a box about `origin` and of a box that is swept along a stretch.
struct Between {
    vec3 origin;      // m
    vec3 nearHalf;    // m, half sides of the box about the origin
    vec3 begin, end;  // m, of the stretch, from the origin
    vec3 farHalf;     // m, half sides of the box along the stretch
    vec3 lowerPace;   // 1/m, see mayLieBetween
    vec3 upperPace;
    vec3 normal;      // unit vector of the plane of origin and stretch; 0: no plane
    float thickness;  // m, from that plane
    vec3 beginSide;   // unit vectors in that plane: away from the ways to the begin and to the
    vec3 endSide;     // end, inward
    vec2 depths;      // m, how far beyond those ways the hull may reach
};

vec3 paceOf(vec3 way) {
    return 1.0 / mix(way, vec3(1e-12), lessThan(abs(way), vec3(1e-12)));
}

Between betweenBoxes(vec3 origin, vec3 nearHalf, vec3 begin, vec3 end, vec3 farHalf) {
    Between between;
    between.origin = origin;
    between.nearHalf = nearHalf;
    between.begin = begin;
    between.end = end;
    between.farHalf = farHalf;
    between.lowerPace = paceOf(min(begin, end) - farHalf + nearHalf);
    between.upperPace = paceOf(max(begin, end) + farHalf - nearHalf);
    between.normal = vec3(0.0);
    between.thickness = 0.0;
    between.beginSide = vec3(0.0);
    between.endSide = vec3(0.0);
    between.depths = vec2(0.0);
    return between;
}

// From a box about `origin` to one about `centre` (from the origin).
Between betweenBoxAndBox(vec3 origin, vec3 nearHalf, vec3 centre, vec3 farHalf) {
    return betweenBoxes(origin, nearHalf, centre, centre, farHalf);
}

// From a box about `origin` (0: the point, the radius in each: a ball) to the stretch.
Between betweenBoxAndStretch(vec3 origin, vec3 nearHalf, vec3 begin, vec3 end) {
    Between between = betweenBoxes(origin, nearHalf, begin, end, vec3(0.0));
    vec3 normal = cross(begin, end);
    float size = length(normal);
    if (size > 1e-4 * length(begin) * length(end)) {
        between.normal = normal / size;
        between.thickness = dot(abs(between.normal), nearHalf) + kBetweenSlack;
        between.beginSide = normalize(cross(between.normal, begin));
        between.endSide = normalize(cross(end, between.normal));
        between.depths = vec2(dot(abs(between.beginSide), nearHalf),
                              dot(abs(between.endSide), nearHalf)) + kBetweenSlack;
    }
    return between;
}

// Whether the hull may touch a box, from the origin. The hull of two boxes is the
// union over s in [0, 1] of the boxes whose sides run linearly from those of the one to
// those of the other: so each axis leaves an interval of s, and the box is touched where
// they have one in common. The box touches the wedge of the stretch besides.
bool mayLieBetween(Between between, vec3 lo, vec3 hi) {
    vec3 atLower = (hi + between.nearHalf + kBetweenSlack) * between.lowerPace;
    vec3 atUpper = (lo - between.nearHalf - kBetweenSlack) * between.upperPace;
    vec3 last = min(mix(vec3(1.0), atLower, greaterThan(between.lowerPace, vec3(0.0))),
                    mix(vec3(1.0), atUpper, lessThan(between.upperPace, vec3(0.0))));
    vec3 first = max(mix(vec3(0.0), atLower, lessThan(between.lowerPace, vec3(0.0))),
                     mix(vec3(0.0), atUpper, greaterThan(between.upperPace, vec3(0.0))));
    float from = max(max(first.x, first.y), max(first.z, 0.0));
    float to = min(min(last.x, last.y), min(last.z, 1.0));
    vec3 centre = 0.5 * (lo + hi);
    vec3 reach = 0.5 * (hi - lo);
    float across = abs(dot(between.normal, centre)) - dot(abs(between.normal), reach);
    vec2 inward = vec2(dot(between.beginSide, centre) + dot(abs(between.beginSide), reach),
                       dot(between.endSide, centre) + dot(abs(between.endSide), reach));
    return from <= to + kBetweenShare && across <= between.thickness &&
           all(greaterThanEqual(inward, -between.depths));
}

// Whether the hull may cross the plane of a face; a wall behind all of it does not.
bool mayCrossPlane(Between between, OccluderFace face) {
    vec3 corner =
        Vec3Array(sceneTable.occluderCorners).at[face.firstCorner] - between.origin;
    float height = dot(face.normal, corner);
    float near = dot(abs(face.normal), between.nearHalf);
    float far = dot(abs(face.normal), between.farHalf);
    float begin = dot(face.normal, between.begin);
    float end = dot(face.normal, between.end);
    return min(-near, min(begin, end) - far) <= height + kBetweenSlack &&
           max(near, max(begin, end) + far) >= height - kBetweenSlack;
}

// Whether a face is the wall that a window lies on: it reaches in front of the window's plane,
// and nowhere further than kPaneOnWall from it. `heights`: of its corners above that plane, m, the
// least and the most.
bool isOwnWall(vec2 heights) {
    return heights.x >= -kPaneOnWall && heights.y <= kPaneOnWall && heights.y > 0.0;
}

// `normal`: of the window, 0 for a sphere, which has no wall.
bool isOwnWall(OccluderFace face, vec3 centre, vec3 normal) {
    vec2 heights = vec2(1e30, -1e30);
    for (uint k = 0u; k < face.cornerCount; ++k) {
        vec3 corner = Vec3Array(sceneTable.occluderCorners).at[face.firstCorner + k];
        float height = dot(normal, corner - centre);
        heights = vec2(min(heights.x, height), max(heights.y, height));
    }
    return isOwnWall(heights);
}

// The next box of a tree that may lie between, or kNone. `walk` is 0 at first.
uint nextBoxBetween(uvec2 tree, inout uint walk, Between between) {
    if (tree == uvec2(0)) {
        return kNone;
    }
    uint count = BoxNodeArray(tree).at[0].next;
    while (walk < count) {
        BoxNode node = BoxNodeArray(tree).at[walk];
        bool touches = mayLieBetween(between, node.lo - between.origin, node.hi - between.origin);
        walk = touches ? walk + 1u : node.next;
        if (touches && node.item != kNone) {
            return node.item;
        }
    }
    return kNone;
}

// The next face that may lie between, or kNone. `walk` is 0 at first.
uint nextOccluder(inout uint walk, Between between) {
    uint face = nextBoxBetween(sceneTable.occluderNodes, walk, between);
    while (face != kNone &&
           !mayCrossPlane(between, OccluderFaceArray(sceneTable.occluderFaces).at[face])) {
        face = nextBoxBetween(sceneTable.occluderNodes, walk, between);
    }
    return face;
}

#endif
