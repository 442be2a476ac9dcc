// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// One value of scene.json with its name: every access checks type and range, and
// what fails is reported by file and field.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace nightcity {

class JsonField {
public:
    // The value must outlive the field.
    JsonField(const std::filesystem::path& file, std::string name, const nlohmann::json& value)
        : file_(file), name_(std::move(name)), value_(value) {}

    // The accessors throw SceneError where the type or the range is another.
    JsonField at(const std::string& key) const;
    JsonField at(std::size_t index) const;
    std::size_t size() const;                                   // of a list
    bool isNull() const { return value_.is_null(); }
    std::uint64_t unsignedNumber(std::uint64_t highest) const;  // 0 to highest
    int integer() const;
    double finiteNumber() const;
    std::string string() const;
    void mustBe(const nlohmann::json& wanted) const;

    [[noreturn]] void fail(const std::string& mend) const;

private:
    const std::filesystem::path& file_;
    std::string name_;
    const nlohmann::json& value_;
};

}  // namespace nightcity
