// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a corner of a triangle lies in the frame: the inverse of cameraRay(), so
// that the pixel's centre stands for its sample.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "camera_ray.glsl"

layout(location = 0) in vec3 position;
layout(location = 0) flat out uint firstTriangle;

// m. z / w is this over the depth: nearer than it nothing is seen, and as there is no far plane,
// float keeps the same relative precision at every depth.
const float kNearDepth = 1e-6;

void main() {
    CameraFrame camera = frameTable.camera;
    float width = float(frameTable.width);
    float height = float(frameTable.height);
    vec2 offset = sampleOffset(push.sampleIndex);
    vec3 fromEye = position - camera.position;
    float depth = dot(fromEye, camera.forward);
    vec2 across = vec2(dot(fromEye, camera.right), dot(fromEye, camera.up)) / camera.tanHalfFov;
    vec2 centre = across - depth * (vec2(camera.shiftX, camera.shiftY) + offset / height);
    gl_Position = vec4(centre.x * height / width, -centre.y, kNearDepth, depth);
    firstTriangle = gl_InstanceIndex;
}
