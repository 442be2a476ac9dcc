// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "options.h"

namespace nightcity {

// What no single option shows: throws UsageError where options exclude each other or
// miss one another. `given` tells whether an option was on the command line.
void checkCombinations(const Options& options, const std::function<bool(const char*)>& given);

}  // namespace nightcity
