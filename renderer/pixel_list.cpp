// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <fstream>
#include <optional>
#include <string_view>

#include "errors.h"
#include "options.h"

namespace nightcity {

namespace {

[[noreturn]] void failLine(const std::filesystem::path& file, std::size_t line,
                           const std::string& why) {
    throw UsageError("--pixels " + file.string() + ": line " + std::to_string(line) + ": " + why);
}

// Takes a whole number and the blanks around it off the text.
std::optional<std::uint32_t> takeNumber(std::string_view& text) {
    const auto skipBlanks = [&] {
        text.remove_prefix(std::min(text.find_first_not_of(" \t\r"), text.size()));
    };
    skipBlanks();
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) {
        return std::nullopt;
    }
    text.remove_prefix(std::size_t(end - text.data()));
    skipBlanks();
    return value;
}

// "x,y", and whatever stands after another comma.
std::optional<glm::uvec2> parsePixel(std::string_view text) {
    const auto x = takeNumber(text);
    if (!x || !text.starts_with(',')) {
        return std::nullopt;
    }
    text.remove_prefix(1);
    const auto y = takeNumber(text);
    if (!y || (!text.empty() && text.front() != ',')) {
        return std::nullopt;
    }
    return glm::uvec2(*x, *y);
}

}  // namespace

std::vector<glm::uvec2> readPixels(const std::filesystem::path& file, glm::uvec2 size) {
    std::ifstream in(file);
    if (!in || std::filesystem::is_directory(file)) {
        throw UsageError("--pixels " + file.string() +
                         ": neither a number nor a file that can be read");
    }
    std::vector<glm::uvec2> pixels;
    std::string text;
    for (std::size_t line = 1; std::getline(in, text); ++line) {
        const bool header = line == 1 && text.find_first_of("0123456789") == std::string::npos;
        if (header || text.find_first_not_of(" \t\r") == std::string::npos) {
            continue;
        }
        const std::optional<glm::uvec2> pixel = parsePixel(text);
        if (!pixel) {
            failLine(file, line, "give a pixel as x,y");
        }
        if (pixel->x >= size.x || pixel->y >= size.y) {
            failLine(file, line, "the pixel " + std::to_string(pixel->x) + "," +
                                     std::to_string(pixel->y) + " lies outside the frame of " +
                                     std::to_string(size.x) + "x" + std::to_string(size.y));
        }
        pixels.push_back(*pixel);
    }
    if (pixels.empty()) {
        throw UsageError("--pixels " + file.string() + ": holds no pixel; give lines x,y");
    }
    return pixels;
}

}  // namespace nightcity
