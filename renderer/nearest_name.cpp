// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "nearest_name.h"

#include <algorithm>
#include <numeric>

namespace nightcity {

namespace {

// Levenshtein's distance, row by row.
std::size_t editsBetween(std::string_view a, std::string_view b) {
    std::vector<std::size_t> edits(b.size() + 1);
    std::iota(edits.begin(), edits.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = edits[0];
        edits[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t set = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = edits[j + 1];
            edits[j + 1] = std::min({set, edits[j] + 1, diagonal + 1});
        }
    }
    return edits[b.size()];
}

}  // namespace

std::string nearestName(std::string_view name, const std::vector<std::string>& names) {
    std::string nearest;
    std::size_t fewest = name.size() / 3 + 1;
    for (const std::string& known : names) {
        const std::size_t edits = editsBetween(name, known);
        if (edits < fewest) {
            fewest = edits;
            nearest = known;
        }
    }
    return nearest;
}

}  // namespace nightcity
