// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/flat_scene.h"

namespace nightcity {

// The windows of each media box's light list that are on at `frame`, ascending; of
// those the first `cap`, where there is one.
std::vector<std::vector<std::uint32_t>> litLists(const FlatScene& scene, int frame,
                                                 std::optional<std::uint32_t> cap);

}  // namespace nightcity
