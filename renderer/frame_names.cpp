// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "frame_names.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <sstream>

#include "errors.h"

namespace nightcity {

namespace {

constexpr std::int64_t kMostFrames = 1000000;

[[noreturn]] void failFrames(const std::string& text, const std::string& why) {
    throw UsageError("--frames " + text + ": " + why +
                     "; give frames like 1-10, 1-10x2 or 1,5,20-30");
}

// Reads one part, like 5, 1-10 or -3--1x2, from its begin to its end.
class RangeReader {
public:
    RangeReader(const std::string& part, const std::string& text)
        : part_(part), text_(text), next_(part.data()), end_(part.data() + part.size()) {}

    void addTo(std::vector<int>& frames) {
        const std::int64_t first = number();
        const std::int64_t last = take('-') ? number() : first;
        const std::int64_t step = last != first && (take('x') || take(':')) ? number() : 1;
        if (next_ != end_) {
            failFrames(text_, "'" + part_ + "' is no range of frames");
        }
        if (last < first || step < 1) {
            failFrames(text_, "'" + part_ + "' must rise by at least 1");
        }
        if ((last - first) / step + 1 + std::int64_t(frames.size()) > kMostFrames) {
            failFrames(text_, "more than a million frames");
        }
        for (std::int64_t frame = first; frame <= last; frame += step) {
            frames.push_back(int(frame));
        }
    }

private:
    int number() {
        int value = 0;
        const auto [after, error] = std::from_chars(next_, end_, value);
        if (error != std::errc()) {
            failFrames(text_, "'" + part_ + "' is no range of frames");
        }
        next_ = after;
        return value;
    }

    bool take(char wanted) {
        const bool found = next_ != end_ && *next_ == wanted;
        next_ += found;
        return found;
    }

    const std::string& part_;
    const std::string& text_;
    const char* next_;
    const char* end_;
};

// Where the place of the frame begins and ends in a name, and its width.
struct FramePlace {
    std::size_t begin = std::string::npos;
    std::size_t length = 0;
    int width = 0;
};

FramePlace findPlace(const std::string& name) {
    constexpr std::size_t kWidest = 12;  // digits and sign of an int
    const std::size_t hash = name.find('#');
    if (hash != std::string::npos) {
        const std::size_t after = std::min(name.find_first_not_of('#', hash), name.size());
        return {hash, after - hash, int(std::min(after - hash, kWidest))};
    }
    for (std::size_t i = name.find('%'); i != std::string::npos; i = name.find('%', i + 1)) {
        const std::string rest = name.substr(i, 4);
        if (rest.starts_with("%d")) {
            return {i, 2, 1};
        }
        if (rest.size() == 4 && rest[1] == '0' && rest[2] >= '1' && rest[2] <= '9' && rest[3] == 'd') {
            return {i, 4, rest[2] - '0'};
        }
    }
    return {};
}

}  // namespace

std::vector<int> parseFrames(const std::string& text) {
    std::vector<int> frames;
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ',');) {
        RangeReader(part, text).addTo(frames);
    }
    if (frames.empty() || text.back() == ',') {
        failFrames(text, "no frame after the last comma");
    }
    std::sort(frames.begin(), frames.end());
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    return frames;
}

bool hasFramePlace(const std::filesystem::path& file) {
    return findPlace(file.filename().string()).begin != std::string::npos;
}

std::filesystem::path frameFile(const std::filesystem::path& file, int frame) {
    std::string name = file.filename().string();
    const FramePlace place = findPlace(name);
    if (place.begin == std::string::npos) {
        return file;
    }
    char digits[32];
    std::snprintf(digits, sizeof digits, "%0*d", place.width, frame);
    name.replace(place.begin, place.length, digits);
    return file.parent_path() / name;
}

}  // namespace nightcity
