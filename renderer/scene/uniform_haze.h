// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/flat_scene.h"

namespace nightcity {

// Whether every straight way from a window to a place in haze lies in haze of one extinction,
// as far as it meets no building: media boxes and box-shaped buildings fill their common
// bounds, which hold the windows. False only means that nobody knows.
bool isHazeUniform(const FlatScene& scene);

}  // namespace nightcity
