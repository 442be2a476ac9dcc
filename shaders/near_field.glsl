// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The near parts of the windows around a piece of a ray, found by a lattice of their own.
#ifndef NIGHTCITY_SHADERS_NEAR_FIELD_GLSL
#define NIGHTCITY_SHADERS_NEAR_FIELD_GLSL

#include "lattice_walk.glsl"
#include "glow.h"
#include "transport/near_window.h"

NIGHTCITY_ARRAY(NearPaneArray, NearPane)

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer NearReference {
    NearTable table;
};

#define nearTable NearReference(sceneTable.nearField).table

bool isPaneLit(uint window) {
    return (UintArray(sceneTable.windowOn).at[window >> 5] >> (window & 31u) & 1u) != 0u;
}

// The ray about the pane, its parameter still that of `ray`.
PaneFrame nearFrame(NearPane pane, Ray ray) {
    vec3 normal = cross(pane.uAxis, pane.vAxis);
    vec3 from = ray.origin - pane.centre;
    PaneFrame frame;
    frame.a = pane.halfU;
    frame.b = pane.halfV;
    frame.origin = vec3(dot(from, pane.uAxis), dot(from, pane.vAxis), dot(from, normal));
    frame.direction = vec3(dot(ray.direction, pane.uAxis), dot(ray.direction, pane.vAxis),
                           dot(ray.direction, normal));
    return frame;
}

// Integral of the near fluence times exp(-extinction (t - begin)) over [begin, end] of the ray,
// W m^-1, in haze of one extinction. A pane stands in the list of every lattice cell that its half
// ball touches, and counts in the one where its chord begins. `inverse` is
// reciprocal(ray.direction); `tolerance` is relative.
vec3 nearGlow(Ray ray, vec3 inverse, float begin, float end, float extinction, float tolerance) {
    vec3 sum = vec3(0.0);
    NearTable near = nearTable;
    Lattice lattice = Lattice(near.origin, near.side, ivec3(near.counts));
    // From where the piece begins: from afar the digits of the way there would be lost.
    Ray local = Ray(ray.origin + begin * ray.direction, ray.direction);
    float span = end - begin;
    float from = 0.0;
    LatticeWalk walk = latticeWalk(local, inverse, 0.0, lattice);
    while (from < span && insideLattice(walk, lattice)) {
        float to = min(cellExit(walk), span);
        uint cell = latticeCell(walk, lattice);
        uint last = UintArray(near.cellStart).at[cell + 1u];
        for (uint entry = UintArray(near.cellStart).at[cell]; entry < last; ++entry) {
            uint index = UintArray(near.cellPanes).at[entry];
            vec3 away = NearPaneArray(near.panes).at[index].centre - local.origin;
            float along = dot(away, local.direction);
            vec3 across = away - along * local.direction;
            if (dot(across, across) >= near.radius * near.radius || !isPaneLit(index)) {
                continue;
            }
            NearPane pane = NearPaneArray(near.panes).at[index];
            if ((pane.flags & kWindowSphere) != 0u) {
                vec2 chord = ballChord(-across, along, near.radius, 0.0, span);
                if (chord.x < chord.y && chord.x >= from && chord.x < to) {
                    sum += pane.radiance * nearSphere(-away, local.direction, pane.halfU, near.radius,
                                                      chord, 0.0, extinction);
                }
                continue;
            }
            PaneFrame frame = nearFrame(pane, local);
            vec2 chord = nearChord(frame, near.radius, 0.0, span);
            if (chord.x < chord.y && chord.x >= from && chord.x < to) {
                sum += pane.radiance *
                       nearWindow(frame, near.radius, chord, 0.0, extinction, tolerance);
            }
        }
        from = to;
        stepOn(walk);
    }
    return sum;
}

#endif
