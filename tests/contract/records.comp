// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Never run: compiled so that a test can read from the SPIR-V how GLSL lays
// out every record of the flat scene.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

#include "facade.h"
#include "scene.h"

layout(local_size_x = 1) in;
layout(scalar, binding = 0) buffer A { Triangle triangles[]; };
layout(scalar, binding = 1) buffer B { Building buildings[]; };
layout(scalar, binding = 2) buffer C { Material materials[]; };
layout(scalar, binding = 3) buffer D { Window windows[]; };
layout(scalar, binding = 4) buffer E { MediaBox mediaBoxes[]; };
layout(scalar, binding = 5) buffer F { WindowEvent windowEvents[]; };
layout(scalar, binding = 6) buffer G { CameraFrame cameraFrames[]; };
layout(scalar, binding = 7) buffer H { Facade facades[]; };

void main() {
    triangles[0].material = buildings[0].firstTriangle + materials[0].width + windows[0].flags +
                            mediaBoxes[0].lightCount + windowEvents[0].on + facades[0].rows;
    cameraFrames[0].aspect = 1.0;
}
