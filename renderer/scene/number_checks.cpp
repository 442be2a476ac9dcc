// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/number_checks.h"

#include <algorithm>
#include <numeric>

namespace nightcity {

std::size_t findDuplicate(const std::vector<uint>& ids) {
    if (ids.empty()) {
        return 0;
    }
    // Ids are mostly 0, 1, 2, ...: one bit each then. Sparse ones are sorted.
    const std::size_t highest = *std::max_element(ids.begin(), ids.end());
    if (highest / 64 <= ids.size()) {
        std::vector<bool> seen(highest + 1);
        for (std::size_t i = 0; i < ids.size(); ++i) {
            if (seen[ids[i]]) {
                return i;
            }
            seen[ids[i]] = true;
        }
        return ids.size();
    }
    std::vector<std::size_t> order(ids.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
    for (std::size_t i = 1; i < order.size(); ++i) {
        if (ids[order[i]] == ids[order[i - 1]]) {
            return order[i];
        }
    }
    return ids.size();
}

}  // namespace nightcity
