// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Prints size and field offsets of every record of the flat scene, as this
// compiler lays them out: one line "record field offset", and "record = size".
#include <cstddef>
#include <cstdio>

#include "facade.h"
#include "scene.h"

#define FIELD(record, field) std::printf(#record " " #field " %zu\n", offsetof(nightcity::record, field))
#define SIZE(record) std::printf(#record " = %zu\n", sizeof(nightcity::record))

int main() {
    FIELD(Triangle, vertex);
    FIELD(Triangle, material);
    SIZE(Triangle);
    FIELD(Building, firstTriangle);
    FIELD(Building, triangleCount);
    FIELD(Building, firstWindow);
    FIELD(Building, windowCount);
    FIELD(Building, buildingId);
    SIZE(Building);
    FIELD(Material, reflectance);
    FIELD(Material, firstTexel);
    FIELD(Material, width);
    FIELD(Material, height);
    SIZE(Material);
    FIELD(Window, centre);
    FIELD(Window, power);
    FIELD(Window, halfU);
    FIELD(Window, building);
    FIELD(Window, halfV);
    FIELD(Window, windowId);
    FIELD(Window, colour);
    FIELD(Window, flags);
    SIZE(Window);
    FIELD(MediaBox, lo);
    FIELD(MediaBox, extinction);
    FIELD(MediaBox, hi);
    FIELD(MediaBox, albedo);
    FIELD(MediaBox, mediaId);
    FIELD(MediaBox, firstLight);
    FIELD(MediaBox, lightCount);
    FIELD(MediaBox, reserved);
    SIZE(MediaBox);
    FIELD(WindowEvent, frame);
    FIELD(WindowEvent, window);
    FIELD(WindowEvent, on);
    SIZE(WindowEvent);
    FIELD(CameraFrame, position);
    FIELD(CameraFrame, tanHalfFov);
    FIELD(CameraFrame, right);
    FIELD(CameraFrame, shiftX);
    FIELD(CameraFrame, up);
    FIELD(CameraFrame, shiftY);
    FIELD(CameraFrame, forward);
    FIELD(CameraFrame, aspect);
    SIZE(CameraFrame);
    FIELD(Facade, origin);
    FIELD(Facade, firstCell);
    FIELD(Facade, uAxis);
    FIELD(Facade, columns);
    FIELD(Facade, vAxis);
    FIELD(Facade, rows);
    FIELD(Facade, cellSize);
    SIZE(Facade);
}
