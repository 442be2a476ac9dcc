// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "options.h"

namespace nightcity {

// Whether an option was on the command line.
using Given = std::function<bool(const char*)>;

// Whether there is something on it that only paths know.
bool asksForPaths(const Options& options, const Given& given);

// What no single option shows: throws UsageError where options exclude each other or
// miss one another.
void checkCombinations(const Options& options, const Given& given);

}  // namespace nightcity
