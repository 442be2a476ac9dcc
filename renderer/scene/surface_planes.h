// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Which triangles and windows lie in one plane, so that what is smooth along it may be
// interpolated. A window counts with the wall behind it.
#pragma once

#include <vector>

#include "scene/facades.h"
#include "scene/flat_scene.h"

namespace nightcity {

struct SurfacePlanes {
    std::vector<uint> ofTriangle;  // one a triangle: a number of its plane
    std::vector<uint> ofWindow;    // one a window
};

SurfacePlanes findSurfacePlanes(const FlatScene& scene, const FacadeTable& facades);

}  // namespace nightcity
