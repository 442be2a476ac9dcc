// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The faces that may hide a window, or part of its pane, from a part of a stretch: looked up once
// a window. What they may touch is the hull of the pane and that part, a flat wedge as thick as
// the pane: even in a large town few faces do.
#ifndef NIGHTCITY_SHADERS_HIDING_FACES_GLSL
#define NIGHTCITY_SHADERS_HIDING_FACES_GLSL

#include "light_reach.glsl"
#include "occluders.glsl"

const uint kMostFaces = 512u;  // that are kept for a window
const uint kMostCandidates = 64u;
const float kNearby = 30.0;    // m

uint hidingFaces[kMostFaces];
uint candidates[kMostCandidates];

struct Hiders {
    Between between;
    vec3 normal;  // of the window, to its bright side; 0 for a sphere
    uint count;   // faces, also those beyond kMostFaces
};

// Whether a face may hide any of the window from the part: some of it lies in the wedge, and it is
// not the wall that the window lies on. Each corner is read once for all of that.
bool mayHide(uint index, Hiders hiders) {
    OccluderFace face = OccluderFaceArray(sceneTable.occluderFaces).at[index];
    Between between = hiders.between;
    vec2 across = vec2(1e30, -1e30);
    vec2 before = across;
    vec2 inward = vec2(-1e30);
    for (uint k = 0u; k < face.cornerCount; ++k) {
        vec3 corner = Vec3Array(sceneTable.occluderCorners).at[face.firstCorner + k] -
                      between.origin;
        float height = dot(between.normal, corner);
        across = vec2(min(across.x, height), max(across.y, height));
        inward = max(inward, vec2(dot(between.beginSide, corner), dot(between.endSide, corner)));
        height = dot(hiders.normal, corner);
        before = vec2(min(before.x, height), max(before.y, height));
    }
    return across.x <= between.thickness && across.y >= -between.thickness &&
           all(greaterThanEqual(inward, -between.depths)) && !isOwnWall(before) &&
           mayCrossPlane(between, face);
}

// Fills candidates with the next faces whose bounds may lie between, until the walk ends or they
// are full, and returns their number. A loop of its own: rays that run side by side wait for
// none of them to look at a face.
uint nextCandidates(inout uint walk, uint end, Between between) {
    uint count = 0u;
    while (walk < end && count < kMostCandidates) {
        BoxNode node = BoxNodeArray(sceneTable.occluderNodes).at[walk];
        bool touches = mayLieBetween(between, node.lo - between.origin, node.hi - between.origin);
        candidates[count] = node.item;
        count += touches && node.item != kNone ? 1u : 0u;
        walk = touches ? walk + 1u : node.next;
    }
    return count;
}

// `range`: t of the part's begin and end, m; `share`: of the ways from the window to the part,
// beyond which no face is looked for. Fills hidingFaces, as far as they fit.
Hiders findHiders(Window window, Stretch stretch, vec2 range, float share) {
    Hiders hiders;
    hiders.count = 0u;
    if (kVisibility == 0u) {
        return hiders;
    }
    vec3 reach = kindOf(window) == kEmitterPane ? abs(window.halfU) + abs(window.halfV)
                                                 : vec3(0.0);
    vec3 begin = beginFrom(stretch, window.centre);
    hiders.normal = outward(window);
    hiders.between =
        betweenBoxAndStretch(window.centre, reach, share * (begin + range.x * stretch.direction),
                             share * (begin + range.y * stretch.direction));
    uint walk = 0u;
    uint end = sceneTable.occluderNodes == uvec2(0)
                   ? 0u : BoxNodeArray(sceneTable.occluderNodes).at[0].next;
    while (walk < end) {
        uint count = nextCandidates(walk, end, hiders.between);
        for (uint k = 0u; k < count; ++k) {
            if (mayHide(candidates[k], hiders)) {
                hidingFaces[min(hiders.count, kMostFaces - 1u)] = candidates[k];
                ++hiders.count;
            }
        }
    }
    return hiders;
}

// The next face that hidingFaces has no room for, or kNone. `walk` and `passed` are 0 at first.
uint nextUnkept(Hiders hiders, inout uint walk, inout uint passed) {
    uint index = hiders.count > kMostFaces ? nextOccluder(walk, hiders.between) : kNone;
    while (index != kNone) {
        bool hides = mayHide(index, hiders);
        passed += hides ? 1u : 0u;
        if (hides && passed > kMostFaces) {
            break;
        }
        index = nextOccluder(walk, hiders.between);
    }
    return index;
}

// The shadows on a range of the stretch, for one point of the window.
Shadows shadowsOn(PointView view, Hiders hiders, vec2 range) {
    Shadows shadows = noShadows(range.x, range.y);
    for (uint k = 0u; k < min(hiders.count, kMostFaces) && shadows.from < range.y; ++k) {
        addShadow(shadows, shadowOf(view, hidingFaces[k]));
    }
    return shadows;
}

// Whether faces within kNearby of a window hide it from all of a part: most windows of a city are
// so hidden, by what stands opposite. Of a pane its middle and its corners are asked, as
// gauss.comp does before it cuts it.
bool isHiddenNearby(Window window, Stretch stretch, vec2 range) {
    float distance = max(distanceTo(stretch, window.centre, 0.0), kNearby);
    Hiders hiders = findHiders(window, stretch, range, kNearby / distance);
    uint points = kindOf(window) == kEmitterPane ? 5u : 1u;
    bool isHidden = hiders.count > 0u && hiders.count <= kMostFaces;
    for (uint k = 0u; k < points && isHidden; ++k) {
        vec2 corner = k == 0u ? vec2(0.0) : vec2(k & 1u, k >> 1 & 1u) * 2.0 - 1.0;
        PointView view =
            pointView(window.centre, corner.x * window.halfU + corner.y * window.halfV, stretch);
        Shadows shadows = shadowsOn(view, hiders, range);
        isHidden = firstSeen(shadows).x >= range.y;
    }
    return isHidden;
}

#endif
