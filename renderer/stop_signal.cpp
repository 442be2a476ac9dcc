// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "stop_signal.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <mutex>
#include <thread>

namespace nightcity {

namespace {

constexpr std::chrono::seconds kGrace{1};
constexpr int kSignalExit = 128;  // added to the signal: 143 for TERM

std::atomic<int> caught = 0;
std::mutex finishing;  // held while a file is being written, and for good at the end
std::once_flag reported;

void awaitSignal(sigset_t signals) {
    int signal = 0;
    while (sigwait(&signals, &signal) != 0) {
    }
    caught = signal;
    std::this_thread::sleep_for(kGrace);
    finishing.lock();
    std::_Exit(reportStop(signal));
}

}  // namespace

void watchStopSignals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::signal(SIGXFSZ, SIG_IGN);
    std::thread(awaitSignal, signals).detach();
}

void stopIfAsked() {
    if (const int signal = caught) {
        throw Stopped{signal};
    }
}

FinishFirst::FinishFirst() {
    finishing.lock();
}

FinishFirst::~FinishFirst() {
    finishing.unlock();
}

int reportStop(int signal) {
    std::call_once(reported, [signal] {
        std::cerr << "nightcity-render: stopped by signal " << signal
                  << "; the images that were finished are kept" << std::endl;
    });
    return kSignalExit + signal;
}

}  // namespace nightcity
