// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace nightcity {

// The one of `names` that fewest letters set, left out or put in make of `name`; none where that
// is more than a third of its letters.
std::string nearestName(std::string_view name, const std::vector<std::string>& names);

}  // namespace nightcity
