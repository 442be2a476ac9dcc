// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace nightcity {

// Thrown where work ends because the process was told to (TERM or INT).
struct Stopped {
    int signal;
};

// From now on TERM and INT are noted instead of ending the process at once, and a file that
// grows past the process's limit is an error of the write, not the end of the process.
void watchStopSignals();

// Throws Stopped once one has come.
void stopIfAsked();

}  // namespace nightcity
