// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/json_field.h"

#include <cmath>
#include <limits>

#include "scene/fault.h"

namespace nightcity {

JsonField JsonField::at(const std::string& key) const {
    if (!value_.is_object()) {
        fail("must be an object; export the stage again");
    }
    const auto found = value_.find(key);
    const std::string name = name_.empty() ? key : name_ + "." + key;
    if (found == value_.end()) {
        failScene(file_, name, "missing", "export the stage again with this version");
    }
    return {file_, name, *found};
}

JsonField JsonField::at(std::size_t index) const {
    const std::string name = name_ + "[" + std::to_string(index) + "]";
    if (index >= size()) {
        failScene(file_, name, "missing", "export the stage again with this version");
    }
    return {file_, name, value_[index]};
}

std::size_t JsonField::size() const {
    if (!value_.is_array()) {
        fail("must be a list; export the stage again");
    }
    return value_.size();
}

std::uint64_t JsonField::unsignedNumber(std::uint64_t highest) const {
    if (!value_.is_number_unsigned() || value_.get<std::uint64_t>() > highest) {
        fail("must be a whole number from 0 to " + std::to_string(highest));
    }
    return value_.get<std::uint64_t>();
}

int JsonField::integer() const {
    const bool small = value_.is_number_unsigned()
                           ? value_.get<std::uint64_t>() <= std::numeric_limits<int>::max()
                           : value_.is_number_integer() &&
                                 value_.get<std::int64_t>() >= std::numeric_limits<int>::min();
    if (!small) {
        fail("must be a whole number of 32 bits");
    }
    return value_.get<int>();
}

double JsonField::finiteNumber() const {
    if (!value_.is_number() || !std::isfinite(value_.get<double>())) {
        fail("must be a finite number");
    }
    return value_.get<double>();
}

std::string JsonField::string() const {
    if (!value_.is_string()) {
        fail("must be text");
    }
    return value_.get<std::string>();
}

void JsonField::mustBe(const nlohmann::json& wanted) const {
    if (value_ != wanted) {
        fail("this program reads " + wanted.dump() + "; export the stage again with its version");
    }
}

void JsonField::fail(const std::string& mend) const {
    constexpr std::size_t kLongest = 80;  // bytes of a foreign value that a message shows
    // Lists and objects may be nested deeper than the stack, and dump() recurses.
    std::string shown = value_.is_structured() ? std::string(value_.type_name()) + " of " +
                                                     std::to_string(value_.size()) + " entries"
                                               : value_.dump(-1, ' ', true);
    if (shown.size() > kLongest) {
        shown = shown.substr(0, kLongest) + "...";
    }
    failScene(file_, name_.empty() ? "the manifest" : name_, shown, mend);
}

}  // namespace nightcity
