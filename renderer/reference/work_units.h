// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace nightcity {

// Runs work(0) to work(count - 1) on all cores and progress(share done, 0 to 1) on
// this thread. What either throws ends the rest and is thrown again.
void forEachUnit(std::size_t count, const std::function<void(std::size_t)>& work,
                 const std::function<void(double)>& progress);

}  // namespace nightcity
