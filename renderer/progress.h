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

    // "NAME 42 %": redrawn at most ten times a second, or a line each half minute.
    void update(const std::string& name, double share);
    void line(const std::string& text);  // a step that is done

private:
    bool terminal_;
    bool silent_;
    std::ostream& out_;
    std::chrono::steady_clock::time_point last_;
    std::size_t shown_ = 0;  // columns of the line to be redrawn
};

}  // namespace nightcity
