// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the window behind a point of a wall (shaders/shared/facade.h).
#pragma once

#include <vector>

#include "facade.h"
#include "scene/flat_scene.h"

namespace nightcity {

// A triangle belongs to a facade where all of it lies within this distance of the
// facade's plane and faces the same way. m.
inline constexpr double kWallDistance = 0.05;

// The planes of one facade's panes differ by at most this. m.
inline constexpr double kPaneDistance = 0.005;

// A window stands in every cell that its rectangle, grown by this on each side,
// touches. Look the cell up where the ray crosses the facade's own plane: a pane at
// most kPaneDistance from it is then found up to 87 degrees from the normal (and at
// any angle where the panes lie in one plane, the common case). Looked up at the
// wall, 0.01 m behind, it is found up to 84 degrees. m.
inline constexpr double kPaneMargin = 0.1;

struct FacadeTable {
    std::vector<Facade> facades;
    std::vector<uint> cellStart;       // into cellWindow; columns * rows + 1 a facade
    std::vector<uint> cellWindow;      // into FlatScene::windows, ascending in a cell
    std::vector<uint> triangleFacade;  // one a triangle: into facades, or kNone
    // The others, ascending: panes of no building or without a wall of their building
    // behind all of them, and spheres. A pane is drawn as two triangles.
    std::vector<uint> looseWindows;
};

FacadeTable buildFacades(const FlatScene& scene);

}  // namespace nightcity
