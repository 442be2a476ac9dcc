// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// One window and the nodes of an upright column. Along it whatever is linear in space
// is linear in the number of the node; so a convex face hides a pane's point from one
// run of nodes, found without asking each.
#ifndef NIGHTCITY_SHADERS_FAR_COLUMN_GLSL
#define NIGHTCITY_SHADERS_FAR_COLUMN_GLSL

#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_vote : require

#include "far_window.glsl"

layout(constant_id = NIGHTCITY_CONSTANT_FAR_PART) const uint kPart = kSumFront;
layout(constant_id = NIGHTCITY_CONSTANT_FAR_POLYGONS) const uint kPolygons = 1u;

const uint kColumnNodes = kBrickSide;
const float kNearestPoint = 1e-6;  // m, from a point source: closer nodes count as so far
const float kExactHazeSides = 3.0;  // of a brick in different hazes: Column.exactHaze
// Of a haze over the side of a brick: in thicker ones the places where haze is asked for are too far
// apart for its borders.
const float kSmoothDepth = 0.15;
const float kEverywhere = 1e15;     // m; a float holds its square
const float kOnBorder = 1e-3;       // m, of two hazes
const uint kAllNodes = (1u << kColumnNodes) - 1u;

struct Column {
    vec3 foot;      // of node 0, from the brick's centre, m
    float spacing;  // m
    float halfSide; // m, of the brick
    bool isCoarse;  // nodes are too far apart for the shape of a pane
    float exactHaze;  // m, of windows nearer than so each node asks for the haze on its way
    vec2 beside;      // of its foot, where it looks over the roofs from, m
    uint turn;        // 0 to 3, other than that of columns beside it
    vec2 across;      // of the brick, from (0, 0) to (1, 1)
    vec3 acrossX, acrossY;  // weights of the three places of a layer along each axis
    BakedShare baked;
    float ownHaze[kColumnNodes];  // 1/m, without visibility: of the haze that each node lies in
};

// Bit i of each: whether node i does not see that point of the pane.
struct Hidden {
    uvec4 nodes;
};

// What each lane of a subgroup has read is taken lane by lane, of one kind after the other: a loop
// of its own for each kind skips what the others need. A mask has a bit a lane.
uint lanesAtOnce() {
    return min(gl_SubgroupSize, 32u);
}

uint lanesWhere(bool condition) {
    return subgroupBallot(condition && gl_SubgroupInvocationID < 32u).x;
}

uint takeLane(inout uint lanes) {
    uint lane = uint(findLSB(lanes));
    lanes &= lanes - 1u;
    return lane;
}

FarWindow windowOfLane(FarWindow mine, uint lane) {
    FarWindow window;
    window.centre = subgroupBroadcast(mine.centre, lane);
    window.u = subgroupBroadcast(mine.u, lane);
    window.v = subgroupBroadcast(mine.v, lane);
    window.normal = subgroupBroadcast(mine.normal, lane);
    window.a = subgroupBroadcast(mine.a, lane);
    window.b = subgroupBroadcast(mine.b, lane);
    window.exactBelow = subgroupBroadcast(mine.exactBelow, lane);
    window.isSphere = subgroupBroadcast(mine.isSphere, lane);
    window.faceCount = subgroupBroadcast(mine.faceCount, lane);
    window.extinction = subgroupBroadcast(mine.extinction, lane);
    if (kPart != kSumClusters && window.extinction < 0.0) {
        [[unroll]] for (uint i = 0u; i < 3u * kWayWords; ++i) {
            window.ways[i] = subgroupBroadcast(mine.ways[i], lane);
        }
    }
    window.corners = subgroupBroadcast(mine.corners, lane);
    return window;
}

// A number of nodes, within which all conditions so far hold.
struct NodeRange {
    float first, last;
};

// Keeps the nodes i where atFoot + i slope <= 0. A slope of 0 keeps all or none.
void keepBelow(inout NodeRange range, float atFoot, float slope) {
    bool level = abs(slope) < 1e-20;
    float crossing = level ? (atFoot <= 0.0 ? 1e9 : -1e9) : -atFoot / slope;
    if (slope < 0.0 && !level) {
        range.first = max(range.first, crossing);
    } else {
        range.last = min(range.last, crossing);
    }
}

uint nodesOf(NodeRange range) {
    float first = ceil(max(range.first, 0.0));
    float last = floor(min(range.last, float(kColumnNodes) - 1.0));
    return first > last ? 0u : (2u << uint(int(last))) - (1u << uint(int(first)));
}

// A face as one lane of a subgroup reads it for all: reading it in each would cost more
// than what is done with it.
struct ReadFace {
    vec3 normal;
    vec3 corner[4];  // the last repeated where there are three
    bool isMore;     // than four corners
};

ReadFace readFace(uint index, vec3 origin) {
    OccluderFace face = OccluderFaceArray(sceneTable.occluderFaces).at[index];
    ReadFace read;
    read.normal = face.normal;
    read.isMore = face.cornerCount > 4u;
    [[unroll]] for (uint c = 0u; c < 4u; ++c) {
        read.corner[c] = faceCorner(face, min(c, face.cornerCount - 1u), origin);
    }
    return read;
}

ReadFace faceOfLane(ReadFace mine, uint lane) {
    ReadFace face;
    face.normal = subgroupBroadcast(mine.normal, lane);
    [[unroll]] for (uint c = 0u; c < 4u; ++c) {
        face.corner[c] = subgroupBroadcast(mine.corner[c], lane);
    }
    face.isMore = subgroupBroadcast(mine.isMore, lane);
    return face;
}

// The planes of a shadow: all beyond the face, nodes on it not, inside the planes through the
// point and each edge.
NodeRange beyondFace(vec3 normal, vec3 corner, float side, Column column) {
    NodeRange range = NodeRange(0.0, float(kColumnNodes) - 1.0);
    keepBelow(range, side * dot(normal, column.foot - corner) + kOnFace,
              side * normal.z * column.spacing);
    return range;
}

void keepInsideEdge(inout NodeRange range, vec3 toCorner, vec3 toNext, float side, vec3 way,
                    Column column) {
    vec3 plane = cross(toCorner, toNext) * side;
    keepBelow(range, dot(plane, way), plane.z * column.spacing);
}

float sideOf(vec3 normal, vec3 fromCorner) {
    return dot(normal, fromCorner) < 0.0 ? -1.0 : 1.0;
}

uint hiddenByFour(ReadFace face, vec3 point, Column column) {
    float side = sideOf(face.normal, point - face.corner[0]);
    NodeRange range = beyondFace(face.normal, face.corner[0], side, column);
    vec3 way = column.foot - point;
    [[unroll]] for (uint c = 0u; c < 4u; ++c) {
        keepInsideEdge(range, face.corner[c] - point, face.corner[(c + 1u) & 3u] - point, side, way,
                       column);
    }
    return nodesOf(range);
}

// Of a face with more than four corners.
uint hiddenByMore(uint index, vec3 point, Column column, vec3 origin) {
    OccluderFace face = OccluderFaceArray(sceneTable.occluderFaces).at[index];
    vec3 corner = faceCorner(face, 0u, origin);
    float side = sideOf(face.normal, point - corner);
    NodeRange range = beyondFace(face.normal, corner, side, column);
    vec3 way = column.foot - point;
    for (uint c = 0u; c < face.cornerCount; ++c) {
        vec3 next = faceCorner(face, c + 1u, origin);
        keepInsideEdge(range, corner - point, next - point, side, way, column);
        corner = next;
    }
    return nodesOf(range);
}

Hidden hiddenByGround(FarWindow window, vec3 origin) {
    Hidden hidden;
    [[unroll]] for (uint p = 0u; p < 4u; ++p) {
        bool below = kFarVisibility != 0u && sceneTable.groundMaterial != kNone &&
                     origin.z + panePoint(window, p).z < sceneTable.groundHeight;
        hidden.nodes[p] = below ? kAllNodes : 0u;
    }
    return hidden;
}

bool hidesAllNodes(Hidden hidden) {
    return subgroupAll(all(equal(hidden.nodes, uvec4(kAllNodes))));
}

// `entry` is the same in all of the subgroup.
Hidden hiddenFromColumn(uint entry, FarWindow window, Column column, vec3 origin) {
    Hidden hidden;
    hidden.nodes = uvec4(0u);
    if (kFarVisibility == 0u) {
        return hidden;
    }
    hidden = hiddenByGround(window, origin);
    uint faces = window.faceCount > kFarFaces ? 0u : window.faceCount;
    for (uint first = 0u; first < faces; first += lanesAtOnce()) {
        uint lane = min(first + gl_SubgroupInvocationID, faces - 1u);
        uint mine = FarEntryArray(bakeTable.entries).at[entry].face[lane];
        ReadFace read = readFace(mine, origin);
        bool isThere = gl_SubgroupInvocationID < faces - first;
        uint few = lanesWhere(isThere && !read.isMore);
        while (few != 0u && !hidesAllNodes(hidden)) {
            ReadFace face = faceOfLane(read, takeLane(few));
            [[unroll]] for (uint p = 0u; p < 4u; ++p) {
                hidden.nodes[p] |= hiddenByFour(face, panePoint(window, p), column);
            }
        }
        uint more = kPolygons == 0u ? 0u : lanesWhere(isThere && read.isMore);
        while (kPolygons != 0u && more != 0u && !hidesAllNodes(hidden)) {
            uint face = subgroupBroadcast(mine, takeLane(more));
            [[unroll]] for (uint p = 0u; p < 4u; ++p) {
                hidden.nodes[p] |= hiddenByMore(face, panePoint(window, p), column, origin);
            }
        }
    }
    return hidden;
}

// Of the pane's points, by node i.
float seenShare(Hidden hidden, uint i) {
    uvec4 bits = (hidden.nodes >> i) & 1u;
    return 1.0 - 0.25 * float(int(bits.x + bits.y + bits.z + bits.w));
}

// Of the upright edges of the brick, for a column between them. `place`: of the column, from (0, 0)
// to (1, 1).
vec4 edgeWeights(vec2 place) {
    return vec4((1.0 - place.x) * (1.0 - place.y), place.x * (1.0 - place.y),
                (1.0 - place.x) * place.y, place.x * place.y);
}

// Of a cluster, by the foot and the top of the column: between the corners of the brick. `place`:
// of the column, from (0, 0) to (1, 1).
vec2 seenFromCorners(uint corners, vec2 place) {
    vec4 weights = edgeWeights(place);
    vec4 low = vec4((uvec4(corners) >> uvec4(0u, 4u, 8u, 12u)) & 0xfu);
    vec4 high = vec4((uvec4(corners) >> uvec4(16u, 20u, 24u, 28u)) & 0xfu);
    return 0.25 * vec2(dot(low, weights), dot(high, weights));
}

float exactHaze(FarBrick brick, float side) {
    return bakeTable.thickest * side > kSmoothDepth ? kEverywhere
           : brick.mediumCount > 1u                 ? kExactHazeSides * side
                                                    : 0.0;
}

// A window that is far enough to be a point with a second-order term.
bool isQuick(FarWindow window, Column column) {
    if (kPart == kSumCoarse || kPart == kSumClusters) {
        return true;
    }
    vec3 gap = max(abs(window.centre) - column.halfSide, vec3(0.0));
    bool isSmooth = window.extinction >= 0.0 || column.isCoarse ||
                    dot(gap, gap) >= column.exactHaze * column.exactHaze;
    return !window.isSphere && isSmooth &&
           (kFarEmitter != kEmitterPane || column.isCoarse || dot(gap, gap) > window.exactBelow);
}

// 1/m, of the haze at a place, or nearest to it; on a border the mean of both sides, so that what
// interpolation makes of the step there has no bias.
float hazeAt(vec3 place, vec3 origin, FarBrick brick, FarFieldTable field) {
    float least = kEverywhere;
    float sum = 0.0;
    float count = 0.0;
    for (uint i = 0u; i < brick.mediumCount; ++i) {
        uint index = UintArray(field.mediumList).at[brick.firstMedium + i];
        FarMedium medium = MediaArray(field.media).at[index];
        vec3 away = max(max(medium.lo - origin - place, place - medium.hi + origin), vec3(0.0));
        float distance = length(away);
        if (distance < least - kOnBorder) {
            least = distance;
            sum = 0.0;
            count = 0.0;
        }
        sum += distance <= least + kOnBorder ? medium.extinction : 0.0;
        count += distance <= least + kOnBorder ? 1.0 : 0.0;
    }
    return sum / max(count, 1.0);
}

struct QuickColumn {
    vec3 foot, step;    // of the column in the window's frame, m
    vec2 secondOrder;   // half sides^2, m^2
    vec3 extinction;    // 1/m, mean of the ways to nodes 0, 4 and 8
    float perDistance;  // of the solid angle and its like: times height / d^3, per watt
};

float meanExtinction(FarWindow window, vec3 place, vec3 origin, FarFieldTable field) {
    return depthThroughMedia(window.centre, place, origin, field) /
           max(length(place - window.centre), kNearestPoint);
}

// 1/m, the means of the ways to nodes 0, 4 and 8.
vec3 columnExtinction(FarWindow window, Column column) {
    if (window.extinction >= 0.0 || kPart == kSumClusters) {
        return vec3(window.extinction);
    }
    vec3 extinction;
    if (kPart == kSumCoarse) {  // all places of a layer have that of its middle (far_mesh.comp)
        [[unroll]] for (uint layer = 0u; layer < kWaySide; ++layer) {
            extinction[layer] = unpackHalf2x16(window.ways[layer * kWayWords]).x;
        }
        return extinction;
    }
    [[unroll]] for (uint layer = 0u; layer < kWaySide; ++layer) {
        vec2 pair[kWayWords];
        [[unroll]] for (uint i = 0u; i < kWayWords; ++i) {
            pair[i] = unpackHalf2x16(window.ways[layer * kWayWords + i]);
        }
        vec3 rows = vec3(dot(column.acrossX, vec3(pair[0], pair[1].x)),
                         dot(column.acrossX, vec3(pair[1].y, pair[2])),
                         dot(column.acrossX, vec3(pair[3], pair[4].x)));
        extinction[layer] = dot(column.acrossY, rows);
    }
    return extinction;
}

// Of three places at 0, 1/2 and 1.
vec3 betweenThree(float place) {
    float fromMiddle = 2.0 * place - 1.0;
    return vec3(max(-fromMiddle, 0.0), 1.0 - abs(fromMiddle), max(fromMiddle, 0.0));
}

float extinctionAt(vec3 extinction, uint i) {
    return i <= 4u ? mix(extinction.x, extinction.y, 0.25 * float(i))
                   : mix(extinction.y, extinction.z, 0.25 * float(i) - 1.0);
}

QuickColumn quickColumn(FarWindow window, Column column) {
    vec3 way = column.foot - window.centre;
    QuickColumn quick;
    quick.foot = vec3(dot(way, window.u), dot(way, window.v), dot(way, window.normal));
    quick.step = vec3(window.u.z, window.v.z, window.normal.z) * column.spacing;
    quick.secondOrder = kFarEmitter == kEmitterPane
                            ? vec2(window.a * window.a, window.b * window.b)
                            : vec2(0.0);
    quick.extinction = columnExtinction(window, column);
    quick.perDistance = kFarEmitter == kEmitterIsotropic ? 0.5 / kTurn : 2.0 / kTurn;
    return quick;
}

// m^-2: baked part of the fluence per watt at node i.
float quickFluence(QuickColumn quick, Column column, uint i) {
    vec3 point = quick.foot + float(i) * quick.step;
    float squared = max(dot(point, point), kNearestPoint * kNearestPoint);
    float inverse = 1.0 / squared;
    float distance = sqrt(squared);
    float clear = quick.perDistance * inverse;
    if (kFarEmitter != kEmitterIsotropic) {
        clear *= max(point.z, 0.0) * inverse * distance;
    }
    if (kFarEmitter == kEmitterPane && kPart != kSumClusters) {
        vec2 across = 5.0 * point.xy * point.xy * inverse - 1.0;
        clear *= max(1.0 + 0.5 * inverse * dot(quick.secondOrder, across), 0.0);
    }
    float extinction =
        kFarVisibility == 0u ? column.ownHaze[i] : extinctionAt(quick.extinction, i);
    // Clusters lie beyond the near radius.
    float share = kPart == kSumClusters ? 1.0 : shareAt(column.baked, squared);
    return share * clear * exp(-extinction * distance);
}

#endif
