// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The channels of a frame by the names that files give them (design section 7).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "frame.h"

namespace nightcity {

struct Channel {
    std::string_view aov;   // what --aovs calls the group: beauty, glow, ...
    std::string_view name;  // in EXR and CSV
    float (*value)(const Frame& frame, std::size_t pixel);
};

// Standard errors of the glow, which Monte Carlo methods have.
inline constexpr std::string_view kErrorAov = "glowError";
// What Method::field knows of its own error, and what a pixel took.
inline constexpr std::array<std::string_view, 2> kLedgerAovNames{"error", "cost"};

// The AOVs that every method has.
std::vector<std::string> commonAovs();

// Of the AOVs named, in the order of the files. An empty list is all that every method has.
// Throws UsageError for an unknown name, listing the known ones.
std::vector<Channel> selectChannels(std::span<const std::string> aovs);

// Their bits (aovs.h); all that every method has for an empty list.
std::uint32_t aovBits(std::span<const std::string> aovs);

// Throws std::runtime_error with the number of NaN and infinite values and the first
// pixel that holds one.
void requireFinite(const Frame& frame);

}  // namespace nightcity
