// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The ray of a pixel sample (docs/scene_format.md, camera_frame). Directions
// are not unit vectors: their component along the camera's axis is 1, so that
// the ray's parameter is depth.
#ifndef NIGHTCITY_SHADERS_CAMERA_RAY_GLSL
#define NIGHTCITY_SHADERS_CAMERA_RAY_GLSL

#include "addresses.glsl"
#include "two_float.glsl"

struct Ray {
    vec3 origin;
    vec3 direction;
};

// The same ray in two floats, for the ends of segments.
struct PreciseRay {
    TwoFloat origin[3];
    TwoFloat direction[3];
};

uvec2 pixelOf(uint index) {
    uvec2 list = frameTable.pixels;
    if (list != uvec2(0)) {
        return UvecArray(list).at[index];
    }
    uint width = frameTable.width;
    uint row = index / width;
    return uvec2(index - row * width, row);
}

// Of a sample from its pixel's centre, right and up, in frame half heights times the height.
vec2 sampleOffset(uint sampleIndex) {
    return vec2(2.0, -2.0) * Vec2Array(frameTable.samples).at[sampleIndex];
}

// The sample's position, as frame half heights from the frame's centre, right
// and up, times the frame's height: a half-integer and an integer, exact but
// for the offset.
void frameCoordinates(uvec2 pixel, uint sampleIndex, out vec2 centre, out vec2 offset) {
    centre = vec2(2.0 * float(pixel.x) + 1.0 - float(frameTable.width),
                  float(frameTable.height) - 2.0 * float(pixel.y) - 1.0);
    offset = sampleOffset(sampleIndex);
}

Ray cameraRay(uvec2 pixel, uint sampleIndex) {
    CameraFrame camera = frameTable.camera;
    vec2 centre, offset;
    frameCoordinates(pixel, sampleIndex, centre, offset);
    vec2 plane = camera.tanHalfFov *
                 ((centre + offset) / float(frameTable.height) + vec2(camera.shiftX, camera.shiftY));
    return Ray(camera.position,
               camera.forward + (camera.right * plane.x + camera.up * plane.y));
}

TwoFloat preciseCoordinate(float centre, float offset, float shift) {
    float tangent = frameTable.camera.tanHalfFov;
    TwoFloat position =
        divide(twoSum(centre, offset), TwoFloat(float(frameTable.height), 0.0));
    return multiply(TwoFloat(tangent, 0.0), add(position, TwoFloat(shift, 0.0)));
}

PreciseRay preciseCameraRay(uvec2 pixel, uint sampleIndex) {
    CameraFrame camera = frameTable.camera;
    vec2 centre, offset;
    frameCoordinates(pixel, sampleIndex, centre, offset);
    TwoFloat x = preciseCoordinate(centre.x, offset.x, camera.shiftX);
    TwoFloat y = preciseCoordinate(centre.y, offset.y, camera.shiftY);
    PreciseRay ray;
    for (int axis = 0; axis < 3; ++axis) {
        TwoFloat sideways = add(multiply(x, TwoFloat(camera.right[axis], 0.0)),
                                multiply(y, TwoFloat(camera.up[axis], 0.0)));
        ray.origin[axis] = TwoFloat(camera.position[axis], frameTable.positionLow[axis]);
        ray.direction[axis] = add(TwoFloat(camera.forward[axis], 0.0), sideways);
    }
    return ray;
}

#endif
