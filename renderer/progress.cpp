// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <algorithm>

#include <unistd.h>

namespace nightcity {

Progress::Progress(ProgressStyle style, std::ostream& out)
    : terminal_(style == ProgressStyle::terminal ||
                (style == ProgressStyle::automatic && ::isatty(STDOUT_FILENO) == 1)),
      silent_(style == ProgressStyle::none),
      farm_(style == ProgressStyle::farm),
      out_(out),
      last_(std::chrono::steady_clock::now()) {}

void Progress::update(const std::string& name, double share) {
    const auto now = std::chrono::steady_clock::now();
    const auto pause = terminal_ ? std::chrono::milliseconds(100) : std::chrono::seconds(30);
    if (silent_ || now - last_ < pause) {
        return;
    }
    last_ = now;
    if (farm_) {
        printShares(share);
        return;
    }
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

void Progress::frames(std::size_t done, std::size_t total) {
    framesDone_ = done;
    framesTotal_ = total;
    if (farm_) {
        printShares(0);
    }
}

void Progress::printShares(double share) {
    const double all = (double(framesDone_) + share) / double(framesTotal_);
    const int percent = int(100 * std::min(all, 1.0));
    out_ << "openjd_progress: " << percent << "\nALF_PROGRESS " << percent << "%" << std::endl;
}

}  // namespace nightcity
