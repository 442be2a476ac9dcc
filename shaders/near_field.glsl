// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The near parts of the windows around a piece of a ray, found by the tile of the ray.
#ifndef NIGHTCITY_SHADERS_NEAR_FIELD_GLSL
#define NIGHTCITY_SHADERS_NEAR_FIELD_GLSL

#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "glow_tile.glsl"
#include "transport/near_window.h"

layout(constant_id = NIGHTCITY_CONSTANT_NEAR_EMITTER) const uint kNearEmitter = kEmitterPane;
layout(constant_id = NIGHTCITY_CONSTANT_POINTS) const bool kPoints = false;
layout(constant_id = NIGHTCITY_CONSTANT_CUT_ALL) const bool kCutAll = true;
layout(constant_id = NIGHTCITY_CONSTANT_THIN_HAZE) const bool kThinHaze = false;
layout(constant_id = NIGHTCITY_CONSTANT_LEDGER) const bool kLedger = false;

bool isPoint(NearPane pane) {
    return kNearEmitter != kEmitterPane || (kPoints && (pane.flags & kWindowSphere) != 0u);
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

// A piece of a ray in haze of one kind.
struct NearPiece {
    Ray ray;           // from where the piece begins: from afar the digits of the way would be lost
    float span;        // m
    float extinction;  // 1/m
    float radius;      // m, the near radius
    float tolerance;   // relative, as in nodesFor
};

// Of the tiles' lists of panes up to kPanesAtOnce that follow each other, those that some ray of the
// subgroup may be near.
const uint kPanesAtOnce = 128u;
struct PaneList {
    uvec2 panes;  // uint into NearTable.panes
    uint first;
    uvec4 mayMeet;  // a bit a pane
};

// All pieces of a subgroup: within `spread` of a line.
struct PieceBundle {
    vec3 start, direction;
    float spread, first, last;  // m
};

// About the mean of their middles: about one of them it would be twice as wide.
PieceBundle bundleOfSubgroup(NearPiece piece) {
    float lanes = float(subgroupBallotBitCount(subgroupBallot(true)));
    PieceBundle bundle;
    bundle.start =
        subgroupAdd(piece.ray.origin + 0.5 * piece.span * piece.ray.direction) / lanes;
    bundle.direction = normalize(subgroupAdd(piece.ray.direction));
    vec3 begin = piece.ray.origin - bundle.start;
    vec3 end = begin + piece.span * piece.ray.direction;
    float alongBegin = dot(begin, bundle.direction);
    float alongEnd = dot(end, bundle.direction);
    bundle.first = subgroupMin(min(alongBegin, alongEnd));
    bundle.last = subgroupMax(max(alongBegin, alongEnd));
    bundle.spread = subgroupMax(max(length(begin - alongBegin * bundle.direction),
                                    length(end - alongEnd * bundle.direction)));
    return bundle;
}

// Of the line from `first` to `last`, m from its start on.
bool isWithin(vec3 place, float reach, vec3 start, vec3 direction, float first, float last) {
    vec3 away = place - start;
    float along = dot(away, direction);
    vec3 across = away - along * direction;
    return dot(across, across) < reach * reach && along > first - reach && along < last + reach;
}

bool mayBeNear(PieceBundle bundle, vec3 centre, float radius) {
    float reach = radius + bundle.spread + kBundleSlack;
    return isWithin(centre, reach, bundle.start, bundle.direction, bundle.first, bundle.last);
}

// The lanes that integrate share the work: each looks at every so-manieth pane, for all of them.
uvec4 panesNear(PieceBundle bundle, float radius, uvec2 panes, uint first, uint end) {
    uvec4 lanes = subgroupBallot(true);
    uint count = subgroupBallotBitCount(lanes);
    uint rank = subgroupBallotExclusiveBitCount(lanes);
    uvec4 near = uvec4(0u);
    for (uint word = 0u; word < 4u; ++word) {
        uint from = min(first + 32u * word, end);
        uint left = min(end - from, 32u);
        uint bits = 0u;
        for (uint k = rank; k < left; k += count) {
            uint index = UintArray(panes).at[from + k];
            vec3 centre = NearPaneArray(nearTable.panes).at[index].centre;
            bits |= mayBeNear(bundle, centre, radius) ? 1u << k : 0u;
        }
        near[word] = subgroupOr(bits);
    }
    return near;
}

// Takes the first; the list has one.
uint takePane(inout PaneList list) {
    uint word = list.mayMeet.x != 0u   ? 0u
                : list.mayMeet.y != 0u ? 1u
                : list.mayMeet.z != 0u ? 2u
                                       : 3u;
    uint bits = list.mayMeet[word];
    list.mayMeet[word] = bits & (bits - 1u);
    return list.first + 32u * word + uint(findLSB(bits));
}

// Goes on to the next pane that may be near the piece: within the near radius, or where
// isCloseBy, within closeBy. kNone: no more. A loop of its own, so that the threads of a
// subgroup search while they have nothing to integrate, and then all integrate.
uint nextPaneBy(inout PaneList list, NearPiece piece, bool isCloseBy) {
    NearPaneArray panes = NearPaneArray(nearTable.panes);
    uint found = kNone;
    while (list.mayMeet != uvec4(0u) && found == kNone) {
        uint index = UintArray(list.panes).at[takePane(list)];
        float reach = isCloseBy ? panes.at[index].closeBy : piece.radius;
        bool isNear = isWithin(panes.at[index].centre, reach, piece.ray.origin,
                               piece.ray.direction, 0.0, piece.span);
        found = isNear ? index : kNone;
    }
    return found;
}

// Integral of near fluence times exp(-extinction t) over a piece.
struct NearSum {
    vec3 light;   // W m^-1
    float nodes;  // where kLedger: how many were evaluated
};

// A pane as a piece of a ray passes it.
struct NearMeeting {
    NearPane pane;
    PaneFrame frame;
    NearPass pass;
    bool isNear;  // some of the piece is near the pane, which is no point
    bool isCut;   // its integral is taken in pieces
};

NearMeeting meetPane(uint index, NearPiece piece) {
    NearMeeting met;
    met.pane = NearPaneArray(nearTable.panes).at[index];
    met.frame = nearFrame(met.pane, piece.ray);
    vec2 chord = nearChord(met.frame, 0.0, piece.radius, 0.0, piece.span);
    met.pass = nearPass(met.frame, chord, 0.0);
    met.isNear = chord.x < chord.y && !isPoint(met.pane);
    met.isCut = isNearCut(met.pass, met.frame, kCutAll);
    return met;
}

void addMeeting(NearMeeting met, float light, NearPiece piece, inout NearSum sum) {
    sum.light += met.pane.radiance * light;
    if (kLedger) {
        sum.nodes += nodesOfPass(met.pass, met.isCut, piece.tolerance);
    }
}

// Of the panes whose integrals are not taken in pieces. Returns whether there are others.
bool addWholePanes(PaneList list, NearPiece piece, inout NearSum sum) {
    bool others = false;
    for (uint index = nextPaneBy(list, piece, false); index != kNone;
         index = nextPaneBy(list, piece, false)) {
        NearMeeting met = meetPane(index, piece);
        if (met.isNear && met.isCut) {
            others = true;
        } else if (met.isNear) {
            addMeeting(met, nearBeside(met.pass, met.frame, piece.radius, piece.extinction,
                                       piece.tolerance, kThinHaze), piece, sum);
        }
    }
    return others;
}

// Of the others: in a loop of its own, for the pieces are few and long.
void addCutPanes(PaneList list, NearPiece piece, inout NearSum sum) {
    for (uint index = nextPaneBy(list, piece, true); index != kNone;
         index = nextPaneBy(list, piece, true)) {
        NearMeeting met = meetPane(index, piece);
        if (met.isNear && met.isCut) {
            addMeeting(met, nearAtEdges(met.pass, met.frame, piece.radius, piece.extinction,
                                        piece.tolerance), piece, sum);
        }
    }
}

void addPoints(PaneList list, NearPiece piece, inout NearSum sum) {
    for (uint index = nextPaneBy(list, piece, false); index != kNone;
         index = nextPaneBy(list, piece, false)) {
        NearPane pane = NearPaneArray(nearTable.panes).at[index];
        bool hasLobe =
            kNearEmitter == kEmitterLambertian && (pane.flags & kWindowSphere) == 0u;
        PaneFrame frame = nearFrame(pane, piece.ray);
        vec2 chord = nearChord(frame, pane.halfV, piece.radius, 0.0, piece.span);
        if (chord.x < chord.y && isPoint(pane)) {
            sum.light += pane.radiance * nearPoint(frame, hasLobe, pane.halfU, piece.radius, chord,
                                                   0.0, piece.extinction, piece.tolerance);
            if (kLedger) {
                sum.nodes += float(nodesOfPoint(piece.tolerance));
            }
        }
    }
}

// Of all panes around a ray of the tile.
NearSum nearGlow(NearPiece piece, uint tile, GlowTable table) {
    GlowTile found = GlowTileArray(table.tiles).at[tile];
    PieceBundle bundle = bundleOfSubgroup(piece);
    NearSum sum = NearSum(vec3(0.0), 0.0);
    uint end = found.firstPane + found.paneCount;
    for (uint first = found.firstPane; first < end; first += kPanesAtOnce) {
        uvec4 mayMeet = panesNear(bundle, piece.radius, table.tilePanes, first, end);
        PaneList list = PaneList(table.tilePanes, first, mayMeet);
        if (kNearEmitter == kEmitterPane && addWholePanes(list, piece, sum)) {
            addCutPanes(list, piece, sum);
        }
        if (kPoints) {
            addPoints(list, piece, sum);
        }
    }
    return sum;
}

#endif
