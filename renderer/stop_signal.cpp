// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "stop_signal.h"

#include <csignal>

namespace nightcity {

namespace {

volatile std::sig_atomic_t caught = 0;

void note(int signal) {
    caught = signal;
}

}  // namespace

void watchStopSignals() {
    struct sigaction action {};
    action.sa_handler = note;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    sigaction(SIGTERM, &action, nullptr);
    sigaction(SIGINT, &action, nullptr);
    std::signal(SIGXFSZ, SIG_IGN);
}

void stopIfAsked() {
    if (caught != 0) {
        throw Stopped{caught};
    }
}

}  // namespace nightcity
