// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What a surface sends to the camera: a tenth of its colour (the paper shows
// surfaces dimmed), or the light of a window.
#ifndef NIGHTCITY_SHADERS_SURFACE_SHADING_GLSL
#define NIGHTCITY_SHADERS_SURFACE_SHADING_GLSL

#include "intersect.glsl"
#include "primitives.glsl"

const float kDim = 0.1;  // W m^-2 sr^-1 at reflectance 1

float linearFromSrgb(float encoded) {  // IEC 61966-2-1
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

vec3 texelAt(Material material, ivec2 texel) {
    ivec2 size = ivec2(material.width, material.height);
    texel -= size * ivec2(floor(vec2(texel) / vec2(size)));  // the texture repeats
    texel = clamp(texel, ivec2(0), size - 1);
    uint packedColour = UintArray(sceneTable.texels)
                            .at[material.firstTexel + uint(texel.y) * material.width + uint(texel.x)];
    vec3 encoded = unpackUnorm4x8(packedColour).rgb;
    return vec3(linearFromSrgb(encoded.r), linearFromSrgb(encoded.g), linearFromSrgb(encoded.b));
}

// Bilinear, in linear light; texel centres at half integers.
vec3 textureColour(Material material, vec2 texcoord) {
    vec2 position = fract(texcoord) * vec2(material.width, material.height) - 0.5;
    vec2 corner = floor(position);
    vec2 weight = position - corner;
    ivec2 texel = ivec2(corner);
    vec3 lower = mix(texelAt(material, texel), texelAt(material, texel + ivec2(1, 0)), weight.x);
    vec3 upper = mix(texelAt(material, texel + ivec2(0, 1)),
                     texelAt(material, texel + ivec2(1, 1)), weight.x);
    return mix(lower, upper, weight.y);
}

vec3 towardsCamera(vec3 normal, vec3 direction) {
    return dot(normal, direction) > 0.0 ? -normal : normal;
}

vec3 dimRadiance(uint index, vec2 texcoord) {
    Material material = MaterialArray(sceneTable.materials).at[index];
    vec3 colour = material.reflectance;
    if (material.firstTexel != kNone && sceneTable.texcoords != uvec2(0)) {
        colour *= textureColour(material, texcoord);
    }
    return kDim * colour;
}

vec2 texcoordAt(Triangle triangle, vec2 barycentrics) {
    if (sceneTable.texcoords == uvec2(0)) {
        return vec2(0.0);
    }
    Vec2Array texcoords = Vec2Array(sceneTable.texcoords);
    return texcoords.at[triangle.vertex.x] * (1.0 - barycentrics.x - barycentrics.y) +
           texcoords.at[triangle.vertex.y] * barycentrics.x +
           texcoords.at[triangle.vertex.z] * barycentrics.y;
}

// The nearest pane of a facade on the ray. The cell is that of the facade's own plane; the
// panes of its list may stand some millimetres off it, and each is met in its own.
PaneHit facadePane(Ray ray, uint index) {
    PaneHit hit = PaneHit(kFar, kNone);
    Facade facade = FacadeArray(sceneTable.facades).at[index];
    vec3 normal = cross(facade.uAxis, facade.vAxis);
    float towards = dot(ray.direction, normal);
    if (towards >= 0.0) {  // the back of the wall
        return hit;
    }
    float depth = dot(facade.origin - ray.origin, normal) / towards;
    vec3 fromOrigin = (ray.origin - facade.origin) + depth * ray.direction;
    vec2 cell = floor(vec2(dot(fromOrigin, facade.uAxis), dot(fromOrigin, facade.vAxis)) /
                      facade.cellSize);
    if (any(lessThan(cell, vec2(0.0))) ||
        any(greaterThanEqual(cell, vec2(facade.columns, facade.rows)))) {
        return hit;
    }
    uint entry = facade.firstCell + uint(cell.y) * facade.columns + uint(cell.x);
    uint end = UintArray(sceneTable.cellStart).at[entry + 1];
    for (uint i = UintArray(sceneTable.cellStart).at[entry]; i < end; ++i) {
        uint window = UintArray(sceneTable.cellWindow).at[i];
        float paneAt = paneDepth(ray, WindowArray(sceneTable.windows).at[window]);
        if (paneAt > 0.0 && paneAt < hit.depth) {
            hit = PaneHit(paneAt, window);
        }
    }
    return hit;
}

SurfaceRecord shadePane(Ray ray, PaneHit hit) {
    Window window = WindowArray(sceneTable.windows).at[hit.window];
    return SurfaceRecord(paneRadiance(hit.window, window, ray.direction), hit.depth,
                         towardsCamera(paneNormal(window), ray.direction),
                         kPanePrimitive | hit.window);
}

// The wall, or the pane of its facade in front of it.
SurfaceRecord shadeTriangle(Ray ray, TriangleHit hit) {
    uint facade = UintArray(sceneTable.triangleFacade).at[hit.triangle];
    if (facade != kNone) {
        PaneHit pane = facadePane(ray, facade);
        if (pane.window != kNone) {
            return shadePane(ray, pane);
        }
    }
    Triangle triangle = TriangleArray(sceneTable.triangles).at[hit.triangle];
    return SurfaceRecord(dimRadiance(triangle.material, texcoordAt(triangle, hit.barycentrics)),
                         hit.depth, towardsCamera(normalize(hit.normal), ray.direction),
                         hit.triangle);
}

// Where the ray meets the ground plane, or kFar. The expression is that of
// boxInterval, so that a media box that stands on the ground ends there to the bit.
float groundDepth(Ray ray) {
    if (sceneTable.groundMaterial == kNone || abs(ray.direction.z) < kSmallestDirection) {
        return kFar;
    }
    precise float depth =
        (sceneTable.groundHeight - ray.origin.z) * reciprocal(ray.direction).z;
    return depth > 0.0 ? min(depth, kFar) : kFar;
}

SurfaceRecord shadeGround(Ray ray, float depth) {
    vec3 up = vec3(0.0, 0.0, 1.0);
    Material material = MaterialArray(sceneTable.materials).at[sceneTable.groundMaterial];
    return SurfaceRecord(kDim * material.reflectance, depth, towardsCamera(up, ray.direction),
                         kGroundPrimitive);
}

// What a ray sees whose nearest triangle is known.
SurfaceRecord surfaceOn(Ray ray, float ground, TriangleHit hit) {
    SurfaceRecord record = SurfaceRecord(vec3(0.0), kFar, vec3(0.0), kNone);
    if (hit.triangle != kNone) {
        record = shadeTriangle(ray, hit);
    } else if (ground < kFar) {
        record = shadeGround(ray, ground);
    }
    PaneHit loose = nearestLoosePane(ray, hit.depth);
    if (loose.window != kNone && (!isPane(record.primitive) || loose.depth < record.depth)) {
        record = shadePane(ray, loose);
    }
    return record;
}

// The nearest opaque surface on a ray, sky where there is none.
SurfaceRecord nearestSurface(Ray ray) {
    float ground = groundDepth(ray);
    return surfaceOn(ray, ground, nearestTriangle(ray, ground));
}

// The nearest opaque surface on the ray of a pixel's sample. Where the frame is rasterised, the
// triangle found at the pixel is taken if the ray meets it; at some edges, which the raster
// rounds to a fraction of a pixel, it does not.
SurfaceRecord seenSurface(uvec2 pixel, Ray ray) {
    if (frameTable.proposals == uvec2(0)) {
        return nearestSurface(ray);
    }
    float ground = groundDepth(ray);
    uint proposed = UintArray(frameTable.proposals).at[pixel.y * frameTable.width + pixel.x];
    TriangleHit hit = TriangleHit(ground, kNone, vec2(0.0), vec3(0.0));
    if (proposed != kNone) {
        TriangleHit met = planeHit(ray, proposed);
        if (!inside(met)) {
            met = nearestTriangle(ray, ground);
        }
        if (met.depth < ground) {
            hit = met;
        }
    }
    return surfaceOn(ray, ground, hit);
}

#endif
