// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// How the window that a camera ray sees is found from the wall that the ray
// hits: all windows of one building in one plane make a facade, with a grid of
// cells over its plane. Built when a scene is loaded, never stored in a file.
#ifndef NIGHTCITY_SHADERS_FACADE_H
#define NIGHTCITY_SHADERS_FACADE_H

#include "language.h"

NIGHTCITY_BEGIN

// Cell (column, row) covers cellSize.x by cellSize.y metres of the plane
// through origin, spanned by the unit vectors uAxis and vAxis. Its windows are
// cellWindow[cellStart[c]] up to cellWindow[cellStart[c + 1]], exclusive, with
// c = firstCell + row * columns + column. Facade f owns columns * rows + 1
// entries of cellStart.
struct Facade {
    vec3 origin;     // m, lower corner of cell (0, 0), in the plane of the panes
    uint firstCell;  // into cellStart
    vec3 uAxis;
    uint columns;
    vec3 vAxis;      // cross(uAxis, vAxis) points outward
    uint rows;
    vec2 cellSize;   // m
};

NIGHTCITY_END

#endif
