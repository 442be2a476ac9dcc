// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace nightcity {

// Thrown where work ends because the process was told to (TERM or INT).
struct Stopped {
    int signal;
};

// From now on TERM and INT are noted instead of ending the process at once, and a file that
// grows past the process's limit is an error of the write, not the end of the process. Work that
// does not come by stopIfAsked within a second of the signal (nothing stops a dispatch that the
// device has begun) ends with the process, unless it keeps a FinishFirst. To be called before
// there are other threads: they must not get the signals.
void watchStopSignals();

// Throws Stopped once one has come.
void stopIfAsked();

// While one lives, in a single thread, the process goes on: a file is being written.
class FinishFirst {
public:
    FinishFirst();
    ~FinishFirst();
    FinishFirst(const FinishFirst&) = delete;
    FinishFirst& operator=(const FinishFirst&) = delete;
};

// Says on standard error that the signal ended the process. Returns its exit code.
int reportStop(int signal);

}  // namespace nightcity
