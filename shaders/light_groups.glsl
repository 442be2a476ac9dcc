// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The windows that light a stretch, in groups of neighbours, near ones first: what may hide
// them is looked up once for a group. A node of the tree over the windows is left out only
// where all that it can add is below its share, by power, of a tenth of the tolerance of
// what was found before, where all its windows are seen from behind, or where single faces
// hide every place of it from all of the stretch.
#ifndef NIGHTCITY_SHADERS_LIGHT_GROUPS_GLSL
#define NIGHTCITY_SHADERS_LIGHT_GROUPS_GLSL

#include "occluders.glsl"
#include "pane.glsl"
#include "transport/light_importance.h"
#include "window_light.glsl"

layout(constant_id = NIGHTCITY_CONSTANT_LISTED) const uint kListed = 1;

const uint kGroupMost = 24u;       // windows
const uint kDeepestNode = 32u;     // levels of the tree
const uint kMostCandidates = 32u;  // faces that are kept for a group
const float kLeftOut = 0.1;        // of the tolerance
const float kMostPanePieces = 16.0;  // along each side
const float kPaneShare = 0.5;        // of the tolerance

uint openNodes[kDeepestNode];
uint candidateFaces[kMostCandidates];
vec2 hiddenFromAll[kMostCandidates];  // t of the stretch, for each candidate

struct LightGroup {
    vec3 centre;      // m
    vec3 extent;      // m, half sides
    uint node;        // of the tree, the next to look for a window in; of one listed: the window
    uint count;       // windows
    Between between;
    uint candidates;  // faces, also those beyond kMostCandidates
};

float meanOf(vec3 colour) {
    return (colour.r + colour.g + colour.b) / 3.0;
}

uint kindOf(Window window) {
    return (window.flags & kWindowSphere) != 0u ? kEmitterIsotropic : kEmitter;
}

// From the nearest place of the stretch to a box about `centre`, m.
float distanceTo(Stretch stretch, vec3 centre, float radius) {
    vec3 begin = beginFrom(stretch, centre);
    float t = clamp(-dot(begin, stretch.direction), 0.0, stretch.span);
    return max(length(begin + t * stretch.direction) - radius, 0.0);
}

float nodeDistance(Stretch stretch, uint index) {
    vec3 lo = LightNodeArray(sceneTable.lightNodes).at[index].lo;
    vec3 hi = LightNodeArray(sceneTable.lightNodes).at[index].hi;
    return distanceTo(stretch, 0.5 * (lo + hi), 0.0);
}

// The most that 1 W can add to the stretch, as window_light.glsl measures it. 1 / d^2 over a
// line at a distance of h is at most pi / h.
float boundOf(Stretch stretch, LightNode node) {
    float radius = sqrt(nodeRadius2(node));
    float nearest = max(distanceTo(stretch, nodeCentre(node), radius), 1e-6);
    float lobe = 0.25;
    if (kEmitter != kEmitterIsotropic) {
        vec3 begin = stretch.corner + stretch.start;
        // Behind at both ends is behind everywhere: the bright side is convex.
        bool isBehind = facingCosine(node, begin) <= 0.0 &&
                        facingCosine(node, begin + stretch.span * stretch.direction) <= 0.0;
        lobe = isBehind ? 0.0 : 1.0;
    }
    float depth = kHazeIsUniform ? stretch.extinction * nearest : 0.0;
    return lobe * exp(-depth) * min(stretch.span / nearest, kHalfTurn) / nearest;
}

// Fills candidateFaces, as far as they fit.
void findCandidates(inout LightGroup group) {
    uint walk = 0u;
    group.candidates = 0u;
    for (uint face = nextOccluder(walk, group.between); face != kNone;
         face = nextOccluder(walk, group.between)) {
        if (group.candidates < kMostCandidates) {
            candidateFaces[group.candidates] = face;
        }
        ++group.candidates;
    }
}

LightGroup groupAbout(vec3 lo, vec3 hi, uint node, uint count, Stretch stretch) {
    LightGroup group;
    group.centre = 0.5 * (lo + hi);
    group.extent = max(hi - group.centre, group.centre - lo);
    group.node = node;
    group.count = count;
    group.candidates = 0u;
    if (kVisibility != 0u) {
        vec3 begin = beginFrom(stretch, group.centre);
        group.between = betweenBoxAndStretch(group.centre, group.extent, begin,
                                             begin + stretch.span * stretch.direction);
        findCandidates(group);
    }
    return group;
}

// One window that a media box lists.
LightGroup groupOfOne(uint index, Stretch stretch) {
    Window window = WindowArray(sceneTable.windows).at[index];
    vec3 reach = kindOf(window) == kEmitterPane ? abs(window.halfU) + abs(window.halfV)
                                                 : vec3(0.0);
    return groupAbout(window.centre - reach, window.centre + reach, index, 1u, stretch);
}

// Index of the next window of a group of the tree.
uint nextWindow(inout LightGroup group) {
    uint child = LightNodeArray(sceneTable.lightNodes).at[group.node].child;
    while ((child & kLightLeaf) == 0u) {
        child = LightNodeArray(sceneTable.lightNodes).at[++group.node].child;
    }
    ++group.node;
    return child & ~kLightLeaf;
}

// Whether the plane of a face comes as near to the group as a window's own wall does.
bool mayBeOwnWall(LightGroup group, uint index) {
    OccluderFace face = OccluderFaceArray(sceneTable.occluderFaces).at[index];
    vec3 corner = Vec3Array(sceneTable.occluderCorners).at[face.firstCorner];
    float height = abs(dot(face.normal, group.centre - corner));
    return height - dot(abs(face.normal), group.extent) <= kPaneOnWall;
}

// For each candidate what it hides from every corner of the group's box, and so from all of
// the box: a way between the two crosses the face within the hull of the ways between corners.
void findHiddenFromAll(LightGroup group, Stretch stretch, uint count) {
    for (uint k = 0u; k < count; ++k) {
        hiddenFromAll[k] = vec2(0.0, stretch.span);
    }
    uint same = (group.extent.x == 0.0 ? 1u : 0u) | (group.extent.y == 0.0 ? 2u : 0u) |
                 (group.extent.z == 0.0 ? 4u : 0u);
    for (uint corner = 0u; corner < 8u; ++corner) {
        if ((corner & same) != 0u) {
            continue;  // the same as without
        }
        vec3 place = vec3(corner & 1u, corner >> 1 & 1u, corner >> 2) * 2.0 - 1.0;
        PointView view = pointView(group.centre, place * group.extent, stretch);
        for (uint k = 0u; k < count; ++k) {
            if (mayBeOwnWall(group, candidateFaces[k])) {
                hiddenFromAll[k].y = 0.0;
                continue;
            }
            vec2 hidden = shadowOf(view, candidateFaces[k]);
            // Of a corner on the line no plane is known.
            hidden.y = view.interval.h > 1e-4 ? hidden.y : 0.0;
            hiddenFromAll[k] = vec2(max(hiddenFromAll[k].x, hidden.x),
                                    min(hiddenFromAll[k].y, hidden.y));
        }
    }
}

// From the first place to the last that may see any of the group; empty where x >= y.
vec2 rangeOf(LightGroup group, Stretch stretch) {
    if (group.candidates == 0u) {
        return vec2(0.0, stretch.span);
    }
    uint count = min(group.candidates, kMostCandidates);
    findHiddenFromAll(group, stretch, count);
    Shadows shadows = noShadows(0.0, stretch.span);
    for (uint k = 0u; k < count; ++k) {
        addShadow(shadows, hiddenFromAll[k]);
    }
    vec2 seen = firstSeen(shadows);
    if (seen.x >= stretch.span) {
        return vec2(1.0, 0.0);
    }
    float end = stretch.span;
    for (uint pass = 0u; pass < 4u; ++pass) {  // shadows that reach the end, and each other
        for (uint k = 0u; k < count; ++k) {
            end = hiddenFromAll[k].y >= end ? min(end, hiddenFromAll[k].x) : end;
        }
    }
    return vec2(min(seen.x, end), end);
}

// The shadows on the stretch from `from` on, for one point of a window of the group. `normal`:
// of the window; 0 for a sphere.
Shadows shadowsOn(PointView view, vec3 normal, LightGroup group, vec2 range) {
    Shadows shadows = noShadows(range.x, range.y);
    bool fits = group.candidates <= kMostCandidates;
    uint walk = 0u;
    for (uint k = 0u; k < group.candidates; ++k) {
        uint face = fits ? candidateFaces[k] : nextOccluder(walk, group.between);
        if (!isOwnWall(OccluderFaceArray(sceneTable.occluderFaces).at[face], view.anchor, normal)) {
            addShadow(shadows, shadowOf(view, face));
        }
    }
    return shadows;
}

#endif
