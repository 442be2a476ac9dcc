// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The glow of every model but the paper's, exact to the tolerance: for each window, or piece of
// a pane, the parts of the ray that it sees, and over those the integral by quadrature.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "counters.glsl"
#include "light_groups.glsl"
#include "transport/constants.glsl"

layout(local_size_x = kGroupSize) in;

const float kDeepAcross = 0.25;      // optical depth of half a pane that is not taken whole

bool isBehindGround(float height, Stretch stretch) {
    if (kVisibility == 0u || sceneTable.groundMaterial == kNone) {
        return false;
    }
    float middle = stretch.corner.z + stretch.start.z +
                   0.5 * stretch.span * stretch.direction.z;
    return (height < sceneTable.groundHeight) != (middle < sceneTable.groundHeight);
}

// Whether any face may hide any of a pane from any of the range.
bool isShadowed(Window window, Stretch stretch, LightGroup group) {
    if (group.candidates == 0u || group.candidates > kMostCandidates) {
        return group.candidates > 0u;
    }
    vec3 begin = beginFrom(stretch, window.centre);
    Between between =
        betweenBoxAndStretch(window.centre, abs(window.halfU) + abs(window.halfV), begin,
                             begin + stretch.span * stretch.direction);
    for (uint k = 0u; k < group.candidates; ++k) {
        OccluderFace face = OccluderFaceArray(sceneTable.occluderFaces).at[candidateFaces[k]];
        if (mayCrossPlane(between, face) &&
            !isOwnWall(face, window.centre, outward(window))) {
            return true;
        }
    }
    return false;
}

// 1/m, as window_light.glsl measures it, of so many pieces along each side; with a spread of
// 2 two pieces lie about the corners.
float windowOver(Window window, Stretch stretch, LightGroup group, vec2 range, float pieces,
                 float spread) {
    Emitter emitter;
    emitter.kind = kindOf(window);
    emitter.halfU = window.halfU / pieces;
    emitter.halfV = window.halfV / pieces;
    emitter.normal = normalize(cross(window.halfU, window.halfV));
    emitter.nearest = (window.flags & kWindowSphere) != 0u ? length(window.halfU) : 0.0;
    float sum = 0.0;
    for (float piece = 0.0; piece < pieces * pieces; piece += 1.0) {
        float row = floor((piece + 0.5) / pieces);
        float column = piece - row * pieces;
        vec3 offset = spread * ((2.0 * column + 1.0 - pieces) * emitter.halfU +
                                (2.0 * row + 1.0 - pieces) * emitter.halfV);
        PointView view = pointView(window.centre, offset, stretch);
        // Not the middles of the pieces see for them: of those a shadow's edge along the pane
        // would take a whole row at once.
        vec2 place = spread == 1.0 ? vec2(2.0 * row + 1.0, 2.0 * column + 1.0) / pieces - 1.0
                                   : vec2(0.0);
        PointView eye = pointView(window.centre,
                                  offset + place.x * emitter.halfU + place.y * emitter.halfV, stretch);
        float from = range.x;
        while (from < range.y) {
            Shadows shadows = shadowsOn(eye, outward(window), group, vec2(from, range.y));
            while (from < shadows.horizon) {
                vec2 seen = firstSeen(shadows);
                if (seen.y - seen.x > kSliver * stretch.span) {
                    sum += overPart(emitter, view, seen, stretch.extinction);
                }
                from = max(seen.x, seen.y);
                shadows.from = from;
            }
        }
    }
    return sum / (pieces * pieces);
}

// Radiance, W m^-2 sr^-1. `soFar`: the mean of the channels of what is known.
vec3 windowGlow(uint index, Stretch stretch, LightGroup group, vec2 range, float scale,
                float soFar) {
    Window window = WindowArray(sceneTable.windows).at[index];
    if (isBehindGround(window.centre.z, stretch)) {
        return vec3(0.0);
    }
    vec3 power = window.power * window.colour;
    float perWatt = scale * meanOf(power);
    float depthAcross = stretch.extinction * length(window.halfU + window.halfV);
    bool isCut = kindOf(window) == kEmitterPane &&
                 (depthAcross > kDeepAcross || isShadowed(window, stretch, group));
    float pieces = isCut ? 2.0 : 1.0;
    float spread = pieces;
    float sum = 0.0;
    // Each piece of a pane is seen or hidden as one point of it is: they are halved until that
    // matters no more. What only an edge of the pane sees, or does not, pieces that are
    // put into its corners tell before. Errors of many windows add in squares, hence the root.
    for (bool isDone = false; !isDone; spread = 1.0) {
        float before = sum;
        sum = windowOver(window, stretch, group, range, pieces, spread);
        float found = perWatt * sum;
        float allowed = kPaneShare * frameTable.tolerance * sqrt(found * (found + soFar));
        isDone = pieces == 1.0 || (spread == 1.0 && (pieces == kMostPanePieces ||
                                                     abs(found - perWatt * before) <= allowed));
        pieces *= spread == 1.0 ? 2.0 : 1.0;
    }
    return scale * power * sum;
}

vec3 groupGlow(LightGroup group, Stretch stretch, float scale, float soFar) {
    vec2 range = rangeOf(group, stretch);
    vec3 glow = vec3(0.0);
    if (!(range.x < range.y)) {
        return glow;
    }
    for (uint k = 0u; k < group.count; ++k) {
        uint window = kListed != 0u ? group.node : nextWindow(group);
        glow += windowGlow(window, stretch, group, range, scale, soFar + meanOf(glow));
    }
    return glow;
}

uint lightSegments = 0u;

// All windows by the tree; `soFar` is the glow of what comes before on the ray.
vec3 glowOfAll(Stretch stretch, float scale, float soFar) {
    vec3 glow = vec3(0.0);
    if (sceneTable.lightNodes == uvec2(0)) {
        return glow;
    }
    float allPower = LightNodeArray(sceneTable.lightNodes).at[0].power;
    uint open = 1u;
    openNodes[0] = 0u;
    while (open > 0u) {
        uint index = openNodes[--open];
        LightNode node = LightNodeArray(sceneTable.lightNodes).at[index];
        float bound = scale * boundOf(stretch, node) * allPower;
        if (bound <= kLeftOut * frameTable.tolerance * (soFar + meanOf(glow))) {
            continue;
        }
        if (node.count > kGroupMost) {
            bool firstNearer = nodeDistance(stretch, index + 1u) <= nodeDistance(stretch, node.child);
            openNodes[open++] = firstNearer ? node.child : index + 1u;
            openNodes[open++] = firstNearer ? index + 1u : node.child;
            continue;
        }
        LightGroup group = groupAbout(node.lo, node.hi, index, node.count, stretch);
        glow += groupGlow(group, stretch, scale, soFar + meanOf(glow));
        lightSegments += node.count;
    }
    return glow;
}

// The windows that the stretch's box lists, as many as the cap allows.
vec3 glowOfListed(Stretch stretch, float scale, float soFar) {
    MediaBox box = MediaBoxArray(sceneTable.mediaBoxes).at[stretch.box];
    vec3 glow = vec3(0.0);
    uint lit = 0u;
    for (uint k = 0u; k < box.lightCount && lit < frameTable.lightCap; ++k) {
        uint index = UintArray(sceneTable.lightList).at[box.firstLight + k];
        if (!isLit(index)) {
            continue;
        }
        ++lit;
        LightGroup group = groupOfOne(index, stretch);
        glow += groupGlow(group, stretch, scale, soFar + meanOf(glow));
    }
    lightSegments += lit;
    return glow;
}

vec3 stretchGlow(Stretch stretch, float soFar) {
    float scale = kInverse4Pi / kPi * stretch.scattering * exp(-stretch.depthBefore);
    if (stretch.span <= 0.0 || scale <= 0.0) {
        return vec3(0.0);
    }
    return kListed != 0u ? glowOfListed(stretch, scale, soFar)
                         : glowOfAll(stretch, scale, soFar);
}

Segment segmentAt(uint index, uint slot) {
    return SegmentArray(frameTable.segments).at[slot * frameTable.bandRays + index];
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.pixelCount) {
        return;
    }
    RayProgress progress = RayProgressArray(frameTable.progress).at[index];
    for (uint slot = 0u; slot < progress.segments;) {
        Stretch stretch = stretchOf(segmentAt(index, slot), progress.opticalDepth);
        ++slot;
        // With lists each box lights its own part.
        while (kListed == 0u && slot < progress.segments &&
               join(stretch, stretchOf(segmentAt(index, slot), 0.0))) {
            ++slot;
        }
        progress.glow += stretchGlow(stretch, meanOf(progress.glow));
        progress.opticalDepth += stretch.extinction * stretch.span;
    }
    if (progress.segments > 0u) {
        RayProgressArray(frameTable.progress).at[index].glow = progress.glow;
        RayProgressArray(frameTable.progress).at[index].opticalDepth = progress.opticalDepth;
    }
    countLights(lightSegments);
}
