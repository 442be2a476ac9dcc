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

const uint kMostFaces = 64u;  // that are kept for a window
const float kNearby = 30.0;   // m

uint hidingFaces[kMostFaces];

struct Hiders {
    Between between;
    vec3 normal;  // of the window, to its bright side; 0 for a sphere
    uint count;   // faces, also those beyond kMostFaces
};

// Whether all corners of a face lie on one side of the plane through origin and stretch.
bool liesAside(OccluderFace face, Between between) {
    vec2 heights = vec2(1e30, -1e30);
    for (uint k = 0u; k < face.cornerCount; ++k) {
        vec3 corner = Vec3Array(sceneTable.occluderCorners).at[face.firstCorner + k];
        float height = dot(between.normal, corner - between.origin);
        heights = vec2(min(heights.x, height), max(heights.y, height));
    }
    return heights.x > between.thickness || heights.y < -between.thickness;
}

// The next face that may hide any of the window, or kNone. `walk` is 0 at first.
uint nextHiding(inout uint walk, Hiders hiders) {
    uint index = nextOccluder(walk, hiders.between);
    while (index != kNone) {
        OccluderFace face = OccluderFaceArray(sceneTable.occluderFaces).at[index];
        if (!liesAside(face, hiders.between) &&
            !isOwnWall(face, hiders.between.origin, hiders.normal)) {
            break;
        }
        index = nextOccluder(walk, hiders.between);
    }
    return index;
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
    for (uint face = nextHiding(walk, hiders); face != kNone; face = nextHiding(walk, hiders)) {
        if (hiders.count < kMostFaces) {
            hidingFaces[hiders.count] = face;
        }
        ++hiders.count;
    }
    return hiders;
}

// The next of the faces found, from number `k` on; `walk` is 0 at first.
uint hidingFace(Hiders hiders, uint k, inout uint walk) {
    return hiders.count <= kMostFaces ? hidingFaces[k] : nextHiding(walk, hiders);
}

// The shadows on a range of the stretch, for one point of the window.
Shadows shadowsOn(PointView view, Hiders hiders, vec2 range) {
    Shadows shadows = noShadows(range.x, range.y);
    uint walk = 0u;
    for (uint k = 0u; k < hiders.count && shadows.from < range.y; ++k) {
        addShadow(shadows, shadowOf(view, hidingFace(hiders, k, walk)));
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
