// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The checks of single numbers that the arrays of a scene share.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "scene/fault.h"

namespace nightcity {

inline constexpr char kExportAgain[] = "export the stage again";

inline bool finite(vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline bool notNegative(float v) {
    return v >= 0 && std::isfinite(v);  // false for NaN
}

inline bool notNegative(vec3 v) {
    return notNegative(v.x) && notNegative(v.y) && notNegative(v.z);
}

inline bool unitInterval(float v) {
    return v >= 0 && v <= 1;
}

// Index of the second of two equal ids, or ids.size() where all differ.
std::size_t findDuplicate(const std::vector<uint>& ids);

}  // namespace nightcity
