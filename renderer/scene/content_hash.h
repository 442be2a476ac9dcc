// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace nightcity {

// XXH3-128 in its canonical form: 32 lower-case hexadecimal digits.
std::string contentHash(std::span<const std::byte> bytes);
std::string contentHash(std::string_view text);

}  // namespace nightcity
