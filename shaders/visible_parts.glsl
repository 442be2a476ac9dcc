// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which parts of a stretch a point sees, found and not stepped over: the plane through both
// cuts a convex face in a chord, and the chord's shadow on the stretch is one interval
// (renderer/reference/shadow_intervals.h does the same in double precision). Shadows are
// gathered in a list; where more fall than it holds, it answers for the stretch up to the first
// that was left out, and is gathered again from there.
#ifndef NIGHTCITY_SHADERS_VISIBLE_PARTS_GLSL
#define NIGHTCITY_SHADERS_VISIBLE_PARTS_GLSL

#include "stretch.glsl"

const uint kMostShadows = 8u;
const float kNoShadow = 1e30;     // m along the stretch
// Of the way from the point to the line of the stretch: what is nearer hides nothing.
const float kNearPoint = 1e-6;
const float kSliver = 1e-6;       // of a stretch: rounding leaves such gaps between neighbours

// A stretch as a point sees it: in the plane of both, x runs along the stretch and y from the
// point to its line, which lies at y = h of the interval.
struct PointView {
    vec3 anchor;  // m, as the scene holds it
    vec3 offset;  // m, from there to the point
    vec3 along;   // unit vectors: x, y, and the normal of the plane
    vec3 across;
    vec3 side;
    AirlightInterval interval;  // t from 0 at the stretch's begin
};

vec3 anyPerpendicular(vec3 direction) {
    vec3 axis = abs(direction.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
    return normalize(cross(direction, axis));
}

PointView pointView(vec3 anchor, vec3 offset, Stretch stretch) {
    PointView view;
    view.anchor = anchor;
    view.offset = offset;
    view.along = stretch.direction;
    view.interval = airlightInterval(beginFrom(stretch, anchor) - offset, stretch.direction, 0.0,
                                     stretch.span);
    float size = length(view.interval.foot);
    view.across = size > kAirlightNearest ? view.interval.foot / size
                                          : anyPerpendicular(stretch.direction);
    view.side = cross(view.along, view.across);
    return view;
}

vec3 inView(PointView view, vec3 corner) {
    vec3 from = (corner - view.anchor) - view.offset;
    return vec3(dot(from, view.along), dot(from, view.across), dot(from, view.side));
}

// Cuts a range of [0, 1] to where a quantity that runs linearly from atZero to atOne is not
// negative.
void keepPositive(float atZero, float atOne, inout vec2 range) {
    if (atZero < 0.0 && atOne < 0.0) {
        range.y = -1.0;
    } else if (atZero < 0.0) {
        range.x = max(range.x, atZero / (atZero - atOne));
    } else if (atOne < 0.0) {
        range.y = min(range.y, atZero / (atZero - atOne));
    }
}

// The ends of the chord in which the plane cuts a face. A corner in the plane counts as above
// it, alike for every face that shares it. False where the plane misses the face.
bool chordOf(PointView view, OccluderFace face, out vec2 a, out vec2 b) {
    Vec3Array corners = Vec3Array(sceneTable.occluderCorners);
    uint end = face.firstCorner + face.cornerCount;
    vec3 from = inView(view, corners.at[end - 1u]);
    uint found = 0u;
    b = vec2(0.0);
    a = b;
    for (uint k = face.firstCorner; k < end; ++k) {
        vec3 to = inView(view, corners.at[k]);
        if ((to.z >= 0.0) != (from.z >= 0.0)) {
            vec3 above = to.z >= 0.0 ? to : from;
            vec3 below = to.z >= 0.0 ? from : to;
            a = b;
            b = above.xy + (below.xy - above.xy) * (above.z / (above.z - below.z));
            ++found;
        }
        from = to;
    }
    return found >= 2u;
}

// The part of the stretch (t from its begin, m) that a face hides; empty where x >= y.
vec2 shadowOf(PointView view, uint face) {
    vec2 a, b;
    bool meets = chordOf(view, OccluderFaceArray(sceneTable.occluderFaces).at[face], a, b);
    float h = view.interval.h;
    float nearest = kNearPoint * h;
    vec2 range = vec2(0.0, 1.0);
    keepPositive(a.y - nearest, b.y - nearest, range);
    keepPositive(h - a.y, h - b.y, range);
    if (!meets || !(range.x < range.y)) {
        return vec2(kNoShadow, 0.0);
    }
    vec2 first = mix(a, b, range.x);
    vec2 second = mix(a, b, range.y);
    float p = first.x * h / max(first.y, nearest);
    float q = second.x * h / max(second.y, nearest);
    return clamp(vec2(min(p, q), max(p, q)) - view.interval.ua, 0.0, view.interval.span);
}

// Shadows on a stretch, by their begins.
struct Shadows {
    vec2 part[kMostShadows];
    float from;     // m: all is hidden up to here
    float horizon;  // m: nothing is known from here on
};

Shadows noShadows(float from, float end) {
    Shadows shadows;
    for (uint k = 0u; k < kMostShadows; ++k) {
        shadows.part[k] = vec2(kNoShadow);
    }
    shadows.from = from;
    shadows.horizon = end;
    return shadows;
}

void addShadow(inout Shadows shadows, vec2 part) {
    if (!(part.x < part.y)) {
        return;
    }
    if (part.x <= shadows.from) {
        shadows.from = max(shadows.from, part.y);
        return;
    }
    for (uint k = 0u; k < kMostShadows; ++k) {  // constant indices: the list stays in registers
        vec2 there = shadows.part[k];
        bool isBefore = part.x < there.x;
        shadows.part[k] = isBefore ? part : there;
        part = isBefore ? there : part;
    }
    shadows.horizon = min(shadows.horizon, part.x);  // of what found no place
}

// The first part that is seen; empty where x >= y, then all up to the horizon was given.
vec2 firstSeen(Shadows shadows) {
    float begin = shadows.from;
    float end = shadows.horizon;
    for (uint k = 0u; k < kMostShadows; ++k) {
        vec2 part = shadows.part[k];
        if (part.x <= begin) {
            begin = max(begin, part.y);
        } else {
            end = min(end, part.x);
        }
    }
    return vec2(begin, end);
}

#endif
