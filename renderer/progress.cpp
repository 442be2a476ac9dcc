// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <unistd.h>

namespace nightcity {

Progress::Progress(ProgressStyle style, std::ostream& out)
    : terminal_(style == ProgressStyle::terminal ||
                (style == ProgressStyle::automatic && ::isatty(STDOUT_FILENO) == 1)),
      silent_(style == ProgressStyle::none),
      out_(out),
      last_(std::chrono::steady_clock::now()) {}

void Progress::update(const std::string& name, double share) {
    const auto now = std::chrono::steady_clock::now();
    const auto pause = terminal_ ? std::chrono::milliseconds(100) : std::chrono::seconds(30);
    if (silent_ || now - last_ < pause) {
        return;
    }
    last_ = now;
    const std::string text = name + " " + std::to_string(int(share * 100)) + " %";
    if (terminal_) {
        out_ << "\r" << text;
        for (std::size_t i = text.size(); i < shown_; ++i) {
            out_ << ' ';
        }
        shown_ = text.size();
    } else {
        out_ << text << "\n";
    }
    out_.flush();
}

void Progress::line(const std::string& text) {
    if (silent_) {
        return;
    }
    if (shown_ > 0) {
        out_ << "\r" << std::string(shown_, ' ') << "\r";
        shown_ = 0;
    }
    last_ = std::chrono::steady_clock::now();
    out_ << text << std::endl;
}

}  // namespace nightcity
