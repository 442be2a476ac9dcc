// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds to what each surface sends the light that falls on it straight from the windows, as
// renderer/reference/surface_light.h has it: the irradiance times reflectance / pi.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "primitives.glsl"

#include "hiding_faces.glsl"
#include "transport/constants.glsl"

layout(local_size_x = kGroupSize) in;
layout(constant_id = NIGHTCITY_CONSTANT_MEDIA) const uint kMedia = 1;

const float kDim = 0.1;              // of surface_shading.glsl
const float kBeforeSurface = 1e-3;   // m, towards the camera: inside the box that the ray ends in

// A place of a surface, as a stretch without length.
struct SurfacePoint {
    Stretch stretch;
    vec3 normal;  // unit vector, to the seen side
};

// The place of the camera ray at the surface, put back onto the surface's plane.
SurfacePoint surfacePoint(Ray ray, SurfaceRecord record) {
    vec3 onPlane, across;
    planeOf(record.primitive, onPlane, across);
    across = normalize(across);
    vec3 start = frameTable.positionLow + record.depth * ray.direction;
    start -= dot((ray.origin - onPlane) + start, across) * across;
    SurfacePoint point;
    point.stretch =
        Stretch(ray.origin, start, normalize(ray.direction), 0.0, 0.0, 0.0, 0.0, kNone);
    point.normal = record.normal;
    return point;
}

// The media box that the ray comes from to the point, or kNone.
uint boxBefore(SurfacePoint point) {
    vec3 from = point.stretch.start - kBeforeSurface * point.stretch.direction;
    Between here = betweenBoxAndBox(point.stretch.corner, vec3(0.0), from, vec3(0.0));
    uint walk = 0u;
    for (uint index = nextBoxBetween(sceneTable.mediaNodes, walk, here); index != kNone;
         index = nextBoxBetween(sceneTable.mediaNodes, walk, here)) {
        MediaBox box = MediaBoxArray(sceneTable.mediaBoxes).at[index];
        if (all(lessThanEqual(box.lo - point.stretch.corner, from)) &&
            all(lessThan(from, box.hi - point.stretch.corner))) {
            return index;
        }
    }
    return kNone;
}

// Whether a face stands on the way from the point to a window; not one that the point lies on.
bool stands(uint index, SurfacePoint point, vec3 way) {
    OccluderFace face = OccluderFaceArray(sceneTable.occluderFaces).at[index];
    Vec3Array corners = Vec3Array(sceneTable.occluderCorners);
    uint end = face.firstCorner + face.cornerCount;
    vec3 from = -beginFrom(point.stretch, corners.at[end - 1u]);
    float height = -dot(face.normal, from);
    float along = dot(face.normal, way);
    float part = -height / (abs(along) > 1e-20 ? along : 1e-20);
    bool inside = abs(height) > kBetweenSlack && part > 0.0 && part < 1.0;
    for (uint k = face.firstCorner; k < end && inside; ++k) {
        vec3 to = -beginFrom(point.stretch, corners.at[k]);
        inside = dot(cross(to - from, part * way - from), face.normal) >= 0.0;
        from = to;
    }
    return inside;
}

bool isHidden(SurfacePoint point, vec3 way, Hiders hiders) {
    bool isHidden = false;
    for (uint k = 0u; k < min(hiders.count, kMostFaces) && !isHidden; ++k) {
        isHidden = stands(hidingFaces[k], point, way);
    }
    uint walk = 0u;
    uint passed = 0u;
    for (uint face = nextUnkept(hiders, walk, passed); face != kNone && !isHidden;
         face = nextUnkept(hiders, walk, passed)) {
        isHidden = stands(face, point, way);
    }
    return isHidden;
}

// m^-2, irradiance of 1 W times pi. `extinction`: about the point, where nothing hides windows.
float pieceOver(Window window, vec3 offset, SurfacePoint point, Hiders hiders,
                float extinction) {
    vec3 way = offset - beginFrom(point.stretch, window.centre);
    float d = length(way);
    float received = dot(point.normal, way) / d;
    bool isSphere = (window.flags & kWindowSphere) != 0u;
    float lobe = 0.25;
    if (kEmitter != kEmitterIsotropic && !isSphere) {
        lobe = max(-dot(normalize(cross(window.halfU, window.halfV)), way) / d, 0.0);
    }
    if (received <= 0.0 || lobe <= 0.0 || (isSphere && d < length(window.halfU)) ||
        isHidden(point, way, hiders)) {
        return 0.0;
    }
    float depth = extinction * d;
    if (kVisibility != 0u) {
        depth = kMedia != 0u ? sourceDepth(point.stretch.corner, point.stretch.start, way) : 0.0;
    }
    return received * lobe * exp(-depth) / (d * d);
}

float irradianceOf(Window window, SurfacePoint point, float extinction, float perWatt,
                   float soFar) {
    Hiders hiders = findHiders(window, point.stretch, vec2(0.0), 1.0);
    bool isPane = kEmitter == kEmitterPane && (window.flags & kWindowSphere) == 0u;
    float most = isPane ? kMostPanePieces : 1.0;
    float mean = 0.0;
    for (float pieces = 1.0; pieces <= most; pieces *= 2.0) {
        float before = mean;
        float sum = 0.0;
        for (float piece = 0.0; piece < pieces * pieces; piece += 1.0) {
            float row = floor((piece + 0.5) / pieces);
            float column = piece - row * pieces;
            vec3 offset = ((2.0 * column + 1.0) / pieces - 1.0) * window.halfU +
                          ((2.0 * row + 1.0) / pieces - 1.0) * window.halfV;
            sum += pieceOver(window, isPane ? offset : vec3(0.0), point, hiders, extinction);
        }
        mean = sum / (pieces * pieces);
        float found = perWatt * mean;
        float allowed = kPaneShare * frameTable.tolerance * sqrt(found * (found + soFar));
        if (pieces > 1.0 && abs(found - perWatt * before) <= allowed) {
            break;
        }
    }
    return mean;
}

// The most that 1 W of a node can bring, as pieceOver measures it.
float mostOf(LightNode node, SurfacePoint point) {
    vec3 way = -beginFrom(point.stretch, nodeCentre(node));
    float radius = sqrt(nodeRadius2(node));
    float nearest = max(length(way) - radius, 1e-3);
    vec3 place = point.stretch.corner + point.stretch.start;
    bool isBehind = dot(way, point.normal) < -radius ||
                    (kEmitter != kEmitterIsotropic && facingCosine(node, place) <= 0.0);
    float lobe = kEmitter != kEmitterIsotropic ? 1.0 : 0.25;
    return isBehind ? 0.0 : lobe / (nearest * nearest);
}

bool isBelowGround(float height, SurfacePoint point) {
    float seen = point.stretch.corner.z + point.stretch.start.z + kBetweenSlack * point.normal.z;
    return kVisibility != 0u && sceneTable.groundMaterial != kNone &&
           (height < sceneTable.groundHeight) != (seen < sceneTable.groundHeight);
}

vec3 fromWindow(uint index, SurfacePoint point, float extinction, float soFar) {
    Window window = WindowArray(sceneTable.windows).at[index];
    vec3 power = window.power * window.colour;
    if (isBelowGround(window.centre.z, point) ||
        length(beginFrom(point.stretch, window.centre)) > frameTable.reach) {
        return vec3(0.0);
    }
    return power * irradianceOf(window, point, extinction, meanOf(power), soFar);
}

// Irradiance times pi, W m^-2.
vec3 fromAll(SurfacePoint point, float extinction) {
    vec3 sum = vec3(0.0);
    if (sceneTable.lightNodes == uvec2(0)) {
        return sum;
    }
    float allPower = LightNodeArray(sceneTable.lightNodes).at[0].power;
    uint open = 1u;
    openNodes[0] = 0u;
    while (open > 0u) {
        uint index = openNodes[--open];
        LightNode node = LightNodeArray(sceneTable.lightNodes).at[index];
        if (mostOf(node, point) * allPower <= kLeftOut * frameTable.tolerance * meanOf(sum)) {
            continue;
        }
        if ((node.child & kLightLeaf) == 0u) {
            openChildren(index, node, point.stretch, open);
            continue;
        }
        sum += fromWindow(node.child & ~kLightLeaf, point, extinction, meanOf(sum));
    }
    return sum;
}

vec3 fromListed(SurfacePoint point, uint index, float extinction) {
    vec3 sum = vec3(0.0);
    uint lit = 0u;
    if (index == kNone) {
        return sum;
    }
    MediaBox box = MediaBoxArray(sceneTable.mediaBoxes).at[index];
    for (uint k = 0u; k < box.lightCount && lit < frameTable.lightCap; ++k) {
        uint window = UintArray(sceneTable.lightList).at[box.firstLight + k];
        if (isLit(window)) {
            ++lit;
            sum += fromWindow(window, point, extinction, meanOf(sum));
        }
    }
    return sum;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.pixelCount) {
        return;
    }
    SurfaceRecord record = SurfaceRecordArray(frameTable.surfaces).at[index];
    if (record.primitive == kNone || isPane(record.primitive)) {
        return;
    }
    SurfacePoint point =
        surfacePoint(cameraRay(pixelOf(push.firstPixel + index), push.sampleIndex), record);
    uint box = boxBefore(point);
    float extinction = kMedia != 0u && box != kNone
                           ? MediaBoxArray(sceneTable.mediaBoxes).at[box].extinction
                           : 0.0;
    vec3 sum = kListed != 0u ? fromListed(point, box, extinction) : fromAll(point, extinction);
    vec3 reflectance = record.radiance / kDim;
    SurfaceRecordArray(frameTable.surfaces).at[index].radiance +=
        reflectance / kPi * (sum / kPi);
}
