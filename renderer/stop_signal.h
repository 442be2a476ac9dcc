// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace nightcity {

// Thrown where work ends because the process was told to (TERM or INT).
struct Stopped {
    int signal;
};

// From now on TERM and INT are noted instead of ending the process at once.
void watchStopSignals();

// Throws Stopped once one has come.
void stopIfAsked();

}  // namespace nightcity
