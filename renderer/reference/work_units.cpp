// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/work_units.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace nightcity {

void forEachUnit(std::size_t count, const std::function<void(std::size_t)>& work,
                 const std::function<void(double)>& progress) {
    std::atomic<std::size_t> next{0};
    std::atomic<std::size_t> done{0};
    std::mutex mutex;
    std::exception_ptr error;
    const auto run = [&](bool reports) {
        try {
            for (std::size_t unit = next++; unit < count; unit = next++) {
                work(unit);
                ++done;
                if (reports && progress) {
                    progress(double(done) / double(count));
                }
            }
        } catch (...) {
            const std::lock_guard lock(mutex);
            error = std::current_exception();
            next = count;
        }
    };
    {
        const std::size_t threads =
            std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()), count);
        std::vector<std::jthread> others;
        for (std::size_t i = 1; i < threads; ++i) {
            others.emplace_back(run, false);
        }
        run(true);
    }
    if (error) {
        std::rethrow_exception(error);
    }
    if (progress) {
        progress(1);
    }
}

}  // namespace nightcity
