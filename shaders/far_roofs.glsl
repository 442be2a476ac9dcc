// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Sight from an upright column of nodes over a map of heights, as large bricks ask for it: what
// is opaque counts as solid from the ground to its highest face, so that of each column the nodes
// above some height see a light, and those below do not.
#ifndef NIGHTCITY_SHADERS_FAR_ROOFS_GLSL
#define NIGHTCITY_SHADERS_FAR_ROOFS_GLSL

#include "far_column.glsl"

// Heights along a way are taken from both of its ends on, a cell apart there and farther from each
// other by this share of the distance to the end, m at most: few buildings are so thin.
const float kRoofStep = 0.12;
const float kLongestRoofStep = 8.0;

// m above the brick's centre; `place` is from it.
float roofAt(vec2 place, vec3 origin) {
    ivec2 cell = ivec2(floor((origin.xy - bakeTable.heightOrigin + place) / bakeTable.heightCell));
    ivec2 most = ivec2(bakeTable.heightCounts) - 1;
    ivec2 inside = clamp(cell, ivec2(0), most);
    float height = FloatArray(bakeTable.heights).at[inside.y * (most.x + 1) + inside.x];
    return cell == inside ? height - origin.z : kNoRoof;
}

// Away from what is higher than `height` in the cells around, by as much as a cell is large: there
// a place beside a wall is on the wall's side of the map too.
vec2 besideWalls(vec2 place, float height, vec3 origin) {
    vec2 away = vec2(0.0);
    for (int i = 0; i < 9; ++i) {
        vec2 way = vec2(i % 3, i / 3) - 1.0;
        away -= roofAt(place + bakeTable.heightCell * way, origin) > height ? way : vec2(0.0);
    }
    float length2 = dot(away, away);
    return length2 > 0.0 ? place + bakeTable.heightCell * inversesqrt(length2) * away : place;
}

// Number of the lowest node that sees it, between two nodes as far as the way between them sees it.
float lowestSeen(vec3 from, vec2 foot, Column column, vec3 origin) {
    vec2 way = foot - from.xy;
    float span = length(way);
    float rise = column.foot.z - from.z;
    float lowest = -1.0;
    float reach = bakeTable.heightCell;
    while (reach < 0.5 * span && lowest < float(kColumnNodes)) {
        float share = reach / span;
        float above = roofAt(from.xy + share * way, origin) - from.z;
        float aboveEnd = roofAt(foot - share * way, origin) - from.z;
        lowest = max(lowest, max(above / share, aboveEnd / (1.0 - share)) / column.spacing -
                                 rise / column.spacing);
        reach += clamp(kRoofStep * reach, bakeTable.heightCell, kLongestRoofStep);
    }
    return lowest;
}

#endif
