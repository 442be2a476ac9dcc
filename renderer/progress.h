// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What a person or a farm's log sees while frames render, on standard output:
// standard error is for errors and notes.
#pragma once

#include <chrono>
#include <ostream>
#include <string>

#include "options.h"

namespace nightcity {

class Progress {
public:
    // automatic: a line that is redrawn on a terminal, else plain lines.
    Progress(ProgressStyle style, std::ostream& out);

    // "NAME 42 %": redrawn at most ten times a second, or a line each half minute. In the style
    // of farms the share of all frames, as OpenJobDescription and Tractor read it.
    void update(const std::string& name, double share);
    void line(const std::string& text);  // a step that is done
    void frames(std::size_t done, std::size_t total);  // how far the sequence is

private:
    void printShares(double share);  // of the frame that is being rendered

    bool terminal_;
    bool silent_;
    bool farm_;
    std::size_t framesDone_ = 0;
    std::size_t framesTotal_ = 1;
    std::ostream& out_;
    std::chrono::steady_clock::time_point last_;
    std::size_t shown_ = 0;  // columns of the line to be redrawn
};

}  // namespace nightcity
