// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The records of the flat scene, as docs/scene_format.md lays them out and
// pipeline/export/records.py writes them. Metres, watts, 1/m, z up.
// A contract test holds the three together.
#ifndef NIGHTCITY_SHADERS_SCENE_H
#define NIGHTCITY_SHADERS_SCENE_H

#include "language.h"

NIGHTCITY_BEGIN

NIGHTCITY_CONST uint kNone = 0xffffffffu;      // an index that points nowhere
NIGHTCITY_CONST uint kWindowOn = 1u;           // Window.flags: on at the first frame
NIGHTCITY_CONST uint kWindowSphere = 2u;       // Window.flags: a sphere of radius |halfU|

// A wall hides no pane of which it is this little in front (m, along the pane's normal): panes
// are meant to lie on their walls, and some stages put them there to within rounding, on
// either side.
NIGHTCITY_CONST float kPaneOnWall = 0.05f;

// Opaque geometry, counter-clockwise seen from outside.
struct Triangle {
    uvec3 vertex;   // into position
    uint material;  // into Material
};

struct Building {
    uint firstTriangle;
    uint triangleCount;
    uint firstWindow;
    uint windowCount;
    int buildingId;  // of the stage
};

// Lambertian reflectance, times a texture where firstTexel is not kNone.
struct Material {
    vec3 reflectance;  // linear Rec. 709, 0 to 1
    uint firstTexel;   // into texel: sRGB bytes, bottom row first
    uint width;        // texels
    uint height;       // texels
};

// An emitter: a rectangle that shines to the side of cross(halfU, halfV).
struct Window {
    vec3 centre;    // m
    float power;    // W, when on
    vec3 halfU;     // m
    uint building;  // into Building, or kNone
    vec3 halfV;     // m
    uint windowId;  // of the stage
    vec3 colour;    // multiplies the power, per channel
    uint flags;
};

// Homogeneous haze. A point x is inside where lo <= x < hi in each axis.
struct MediaBox {
    vec3 lo;           // m
    float extinction;  // 1/m
    vec3 hi;           // m
    float albedo;      // 0 to 1
    int mediaId;       // of the stage
    uint firstLight;   // into the light list
    uint lightCount;
    uint reserved;     // 0
};

struct WindowEvent {
    float frame;  // USD time code
    uint window;
    uint on;      // 0 or 1
};

struct CameraFrame {
    vec3 position;     // m
    float tanHalfFov;  // of the vertical field of view
    vec3 right;
    float shiftX;      // fraction of the half height, view moves right
    vec3 up;
    float shiftY;      // fraction of the half height, view moves up
    vec3 forward;
    float aspect;      // aperture width / height
};

NIGHTCITY_END

#endif
