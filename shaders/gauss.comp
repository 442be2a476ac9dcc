// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The glow of every model but the paper's, exact to the tolerance: for each window, or piece of
// a pane, the parts of the ray that it sees, and over those the integral by quadrature.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "counters.glsl"
#include "hiding_faces.glsl"
#include "transport/constants.glsl"

layout(local_size_x = kGroupSize) in;

const float kDeepAcross = 0.25;  // optical depth of half a pane that is not taken whole
const uint kBatch = 32u;         // windows

// Windows that are looked at together: rays that run side by side do the same work at a time, and
// what is soon found hidden keeps none waiting.
uint batch[kBatch];

bool isBehindGround(float height, Stretch stretch) {
    if (kVisibility == 0u || sceneTable.groundMaterial == kNone) {
        return false;
    }
    float middle = stretch.corner.z + stretch.start.z +
                   0.5 * stretch.span * stretch.direction.z;
    return (height < sceneTable.groundHeight) != (middle < sceneTable.groundHeight);
}

// t of the part that lies on the bright side of a window, m; empty where x >= y.
vec2 brightRange(Window window, Stretch stretch) {
    vec2 range = vec2(0.0, stretch.span);
    if (kindOf(window) == kEmitterIsotropic) {
        return range;
    }
    vec3 normal = outward(window);
    float slack = kBetweenSlack;
    float atBegin = dot(normal, beginFrom(stretch, window.centre));
    float slope = dot(normal, stretch.direction);
    float atEnd = atBegin + slope * stretch.span;
    if (atBegin <= 0.0 && atEnd <= 0.0) {
        return vec2(1.0, 0.0);
    }
    float edge = -atBegin / slope;
    range.x = atBegin < 0.0 ? max(edge - slack, 0.0) : 0.0;
    range.y = atEnd < 0.0 ? min(edge + slack, stretch.span) : stretch.span;
    return range;
}

// The part of that within the window's reach.
vec2 litRange(Window window, Stretch stretch) {
    vec2 range = brightRange(window, stretch);
    vec3 begin = beginFrom(stretch, window.centre);
    float foot = -dot(begin, stretch.direction);
    float across2 = squared(begin + foot * stretch.direction);
    float halfLength = sqrt(max(frameTable.reach * frameTable.reach - across2, 0.0));
    return vec2(max(range.x, foot - halfLength), min(range.y, foot + halfLength));
}

// 1/m, as window_light.glsl measures it, of so many pieces along each side; with a spread of
// 2 two pieces lie about the corners.
float windowOver(Window window, Stretch stretch, Hiders hiders, vec2 range, float pieces,
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
            Shadows shadows = shadowsOn(eye, hiders, vec2(from, range.y));
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

// Radiance of a part of the stretch, W m^-2 sr^-1. `soFar`: the mean of the channels of what is
// known.
vec3 partGlow(Window window, Stretch stretch, Hiders hiders, vec2 range, float scale,
              float soFar) {
    vec3 power = window.power * window.colour;
    float perWatt = scale * meanOf(power);
    float depthAcross = stretch.extinction * length(window.halfU + window.halfV);
    bool isCut = kindOf(window) == kEmitterPane &&
                 (depthAcross > kDeepAcross || hiders.count > 0u);
    float sum = windowOver(window, stretch, hiders, range, 1.0, 1.0);
    // Each piece of a pane is seen or hidden as one point of it is: they are halved until that
    // matters no more. What only an edge of the pane sees, or does not, pieces that are
    // put into its corners tell before. Errors of many windows add in squares, hence the root.
    float spread = 2.0;
    for (float pieces = 2.0; isCut && pieces <= kMostPanePieces; spread = 1.0) {
        float next = windowOver(window, stretch, hiders, range, pieces, spread);
        float found = perWatt * max(sum, next);
        float allowed = kPaneShare * frameTable.tolerance * sqrt(found * (found + soFar));
        isCut = abs(found - perWatt * min(sum, next)) > allowed;
        // The whole pane's light is known better than that of its corners.
        sum = spread == 1.0 || isCut ? next : sum;
        pieces *= spread == 1.0 ? 2.0 : 1.0;
    }
    return scale * power * sum;
}

// Radiance, W m^-2 sr^-1. A part that more faces may hide than are kept is halved.
vec3 windowGlow(uint index, Stretch stretch, float scale, float soFar) {
    Window window = WindowArray(sceneTable.windows).at[index];
    vec2 range = litRange(window, stretch);
    vec2 part = range;
    vec3 glow = vec3(0.0);
    while (part.x < part.y) {
        Hiders hiders = findHiders(window, stretch, part, 1.0);
        bool fits = hiders.count <= kMostFaces || part.y - part.x <= kSliver * stretch.span;
        if (fits) {
            glow += partGlow(window, stretch, hiders, part, scale, soFar + meanOf(glow));
        }
        part = fits ? vec2(part.y, range.y) : vec2(part.x, 0.5 * (part.x + part.y));
    }
    return glow;
}

bool maySee(uint index, Stretch stretch) {
    Window window = WindowArray(sceneTable.windows).at[index];
    vec2 range = litRange(window, stretch);
    return range.x < range.y && !isBehindGround(window.centre.z, stretch) &&
           !(kVisibility != 0u && isHiddenNearby(window, stretch, range));
}

vec3 batchGlow(uint count, Stretch stretch, float scale, float soFar) {
    uint seen = 0u;
    for (uint k = 0u; k < count; ++k) {
        if (maySee(batch[k], stretch)) {
            batch[seen++] = batch[k];
        }
    }
    vec3 glow = vec3(0.0);
    for (uint k = 0u; k < seen; ++k) {
        glow += windowGlow(batch[k], stretch, scale, soFar + meanOf(glow));
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
    float share = shareOfDepth(stretch);
    uint open = 1u;
    openNodes[0] = 0u;
    while (open > 0u) {
        uint count = 0u;
        float least = kLeftOut * frameTable.tolerance * (share * soFar + meanOf(glow));
        while (open > 0u && count < kBatch) {
            uint index = openNodes[--open];
            LightNode node = LightNodeArray(sceneTable.lightNodes).at[index];
            if (scale * boundOf(stretch, node) * allPower <= least) {
                continue;
            }
            if ((node.child & kLightLeaf) == 0u) {
                openChildren(index, node, stretch, open);
            } else {
                batch[count++] = node.child & ~kLightLeaf;
            }
        }
        glow += batchGlow(count, stretch, scale, soFar + meanOf(glow));
        lightSegments += count;
    }
    return glow;
}

// The windows that the stretch's box lists, as many as the cap allows.
vec3 glowOfListed(Stretch stretch, float scale, float soFar) {
    MediaBox box = MediaBoxArray(sceneTable.mediaBoxes).at[stretch.box];
    vec3 glow = vec3(0.0);
    uint lit = 0u;
    for (uint k = 0u; k < box.lightCount && lit < frameTable.lightCap;) {
        uint count = 0u;
        for (; k < box.lightCount && count < min(kBatch, frameTable.lightCap - lit); ++k) {
            uint index = UintArray(sceneTable.lightList).at[box.firstLight + k];
            batch[count] = index;
            count += isLit(index) ? 1u : 0u;
        }
        glow += batchGlow(count, stretch, scale, soFar + meanOf(glow));
        lit += count;
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
