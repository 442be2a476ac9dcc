// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What stands between a light and a brick.
#ifndef NIGHTCITY_SHADERS_FAR_HIDING_GLSL
#define NIGHTCITY_SHADERS_FAR_HIDING_GLSL

#include "far_way.glsl"

// An inner light of more faces than this is not asked about further: its windows are.
const uint kMostFacesAsked = 24u;
// Of a window with more faces before it than an entry lists, so many more are asked whether one of
// them alone hides it: the mesh of its sight says so too.
const uint kMostFacesBeyond = 40u;
const float kLargestAsked = 16.0;  // m, half size of the lights that are asked about at all

// On which side of the face's plane all of a box is: 1 or -1; 0 on both.
int boxSide(OccluderFace face, vec3 toCorner, vec3 centre, vec3 halfSides) {
    float height = dot(face.normal, centre - toCorner);
    float reach = dot(abs(face.normal), halfSides);
    return height >= reach ? 1 : height <= -reach ? -1 : 0;
}

// What a face hides of a light's box from a brick.
const uint kHidesNothing = 0u;
const uint kHidesSome = 1u;
const uint kHidesAll = 2u;
// Of the brick's reach across a plane: so much of it rounding may take.
const float kPlaneSlack = 1e-5;

// Of straight ways from the box about `light` to the box about the origin. All cross the face where
// the planes through each corner of the one and each edge keep all of the other on their inner
// side, and nothing of it lies on the face; none does where those of one edge all keep it on their
// outer side.
uint whatFaceHides(OccluderFace face, vec3 origin, vec3 light, vec3 lightHalf, vec3 brickHalf) {
    vec3 corner = faceCorner(face, 0u, origin);
    int lightSide = boxSide(face, corner, light, lightHalf);
    if (lightSide == 0) {
        return kHidesSome;
    }
    bool all = boxSide(face, corner, vec3(0.0), brickHalf + kOnFace) == -lightSide;
    for (uint i = 0u; i < face.cornerCount; ++i) {
        vec3 next = faceCorner(face, i + 1u, origin);
        // The plane's normal and the height of the origin over it are linear in the place of the
        // light: c x n - l x (n - c), and -l . (c x n).
        vec3 edge = next - corner;
        vec3 across = cross(corner, next);
        vec3 plane = abs(across - cross(light, edge)) + abs(edge).zxy * lightHalf.yzx +
                     abs(edge).yzx * lightHalf.zxy;
        float middle = -dot(across, light) * float(lightSide);
        float reach = dot(plane, brickHalf);
        float around = dot(abs(across), lightHalf);
        all = all && middle + around + reach <= 0.0;
        bool outside = middle - around > (1.0 + kPlaneSlack) * reach;
        if (outside) {
            return kHidesNothing;
        }
        corner = next;
    }
    return all ? kHidesAll : kHidesSome;
}

// Whether one face hides all of the light from all of the brick. `way`: from the brick's
// centre to the light's.
bool isHidden(FarLight light, vec3 way, vec3 brickCentre, vec3 brickHalf) {
    if (kFarVisibility == 0u || any(greaterThan(light.reach, vec3(kLargestAsked)))) {
        return false;
    }
    Between between = betweenBoxAndBox(brickCentre, brickHalf, way, light.reach);
    uint walk = 0u;
    uint index = nextOccluder(walk, between);
    for (uint asked = 0u; index != kNone && asked < kMostFacesAsked; ++asked) {
        OccluderFace face = OccluderFaceArray(sceneTable.occluderFaces).at[index];
        if (whatFaceHides(face, brickCentre, way, light.reach, brickHalf) == kHidesAll) {
            return true;
        }
        index = nextOccluder(walk, between);
    }
    return false;
}

// The wall behind a pane: whoever is behind it is behind the pane too, where nothing shines.
bool isBehindPane(FarLight light, OccluderFace face, vec3 toCorner, vec3 way) {
    return light.coneCos >= 0.0 && dot(face.normal, light.axis) > 0.99999 &&
           dot(light.axis, toCorner - way) <= 0.0;
}

// The faces between a window and the brick; false where one hides it from all of it.
bool findFaces(FarLight light, vec3 way, vec3 brickCentre, vec3 brickHalf, out FarEntry entry) {
    entry.faceCount = 0u;
    if (kFarVisibility == 0u) {
        return true;
    }
    Between between = betweenBoxAndBox(brickCentre, brickHalf, way, light.reach);
    uint walk = 0u;
    uint asked = 0u;
    for (uint index = nextOccluder(walk, between); index != kNone && asked < kMostFacesBeyond;
         index = nextOccluder(walk, between)) {
        asked += entry.faceCount == kMesh ? 1u : 0u;
        OccluderFace face = OccluderFaceArray(sceneTable.occluderFaces).at[index];
        if (isBehindPane(light, face, faceCorner(face, 0u, brickCentre), way)) {
            continue;
        }
        uint hidden = whatFaceHides(face, brickCentre, way, light.reach, brickHalf);
        if (hidden == kHidesAll) {
            return false;
        }
        if (hidden == kHidesNothing) {
            continue;
        }
        if (entry.faceCount < kFarFaces) {
            entry.face[entry.faceCount++] = index;
        } else {
            entry.faceCount = kMesh;
        }
    }
    return true;
}

// The light, or a part of it, that stands for it: kPartLevels down at most, by as many bits.
vec3 partOf(uint index, uint bits) {
    FarLight light = FarLightArray(bakeTable.lights).at[index];
    for (uint level = 0u; level < kPartLevels && light.second != 0u; ++level) {
        index = (bits >> level & 1u) == 0u ? index + 1u : light.second;
        light = FarLightArray(bakeTable.lights).at[index];
    }
    return WindowArray(sceneTable.windows).at[light.window].centre;
}

// Where it is asked what a place sees. One behind all panes of a light would see nothing, and take as
// much from the nodes before the panes about it, though it is the cosine that darkens there:
// the nearest place `before` them, m, speaks for it.
vec3 askedPlace(vec3 place, FarLight light, vec3 centre, float before) {
    float coneSin = sqrt(max(1.0 - light.coneCos * light.coneCos, 0.0));
    float height = dot(light.axis, place - centre);
    bool isBehind = light.coneCos >= 0.0 && height <= -coneSin * length(place - centre);
    return isBehind ? place + (before - height) * light.axis : place;
}

// Quarters of the light that a place sees.
uint seenFrom(vec3 place, uint index, uint bits, vec3 brickCentre) {
    uint seen = 4u;
    for (uint k = 0u; k < 2u && kFarVisibility != 0u; ++k) {
        vec3 part = partOf(index, k == 0u ? bits : 7u - bits) - brickCentre;
        seen -= isHiddenByAny(part, place, brickCentre) ? 2u : 0u;
    }
    return seen;
}

// What the corners of a brick see of a light, as FarEntry has it. Two of its windows from each,
// others from each neighbour but the same for all bricks of a corner. For a corner in a solid the
// others speak; where all are, the brick's centre.
uint seenFromCorners(uint index, FarBrick brick, vec3 brickCentre, vec3 brickHalf) {
    FarLight light = FarLightArray(bakeTable.lights).at[index];
    float spacing = 2.0 * brickHalf.x / float(kBrickSteps);
    uint corners = 0u;
    uint sum = 0u;
    uint inAir = 0u;
    uint solid = 0u;
    for (uint c = 0u; c < 8u; ++c) {
        uvec3 offset = uvec3(c, c >> 1, c >> 2) & 1u;
        if (isSolid(groupBrick(), nodeAt(offset * kBrickSteps))) {
            solid |= 1u << c;
            continue;
        }
        uvec3 parity = ((brick.cell >> brick.scale) + offset) & 1u;
        uint bits = parity.x | parity.y << 1 | parity.z << 2;
        vec3 place = askedPlace((vec3(offset) * 2.0 - 1.0) * brickHalf, light,
                                light.centre - brickCentre, spacing);
        uint seen = seenFrom(place, index, bits, brickCentre);
        corners |= seen << (4u * c);
        sum += seen;
        inAir += 1u;
    }
    if (inAir == 0u) {
        sum = seenFrom(vec3(0.0), index, 0u, brickCentre);
        inAir = 1u;
    }
    for (uint c = 0u; c < 8u; ++c) {
        corners |= (solid >> c & 1u) * ((sum + inAir / 2u) / inAir) << (4u * c);
    }
    return corners;
}

#endif
