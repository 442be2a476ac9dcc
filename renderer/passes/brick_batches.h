// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Visits all bricks of the far field in batches that take the device a moment each: so long no
// process waits that is told to stop, and no watchdog bites.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>

namespace nightcity {

// Called between dispatches with what is done of a bake, from 0 to 1; what it throws ends the bake.
using BakeProgress = std::function<void(double)>;

// Of all that a bake does.
struct BakeShare {
    double from, to;
};

struct BrickBatch {
    std::uint32_t first, count;
};

inline constexpr std::uint32_t kBatchBricks = 512;  // most

// A visit of a BrickBatch returns how many of its bricks it did.
template <typename Visit>
void forBatches(std::uint32_t bricks, const BakeProgress& progress, BakeShare share,
                Visit&& visit) {
    constexpr std::uint32_t kFirstBatch = 8;
    constexpr double kBatchSeconds = 0.2;      // that a batch should take the device
    constexpr std::uint32_t kBatchGrowth = 4;  // at most, from one to the next
    using Clock = std::chrono::steady_clock;
    std::uint32_t most = kFirstBatch;
    for (std::uint32_t first = 0; first < bricks;) {
        const Clock::time_point start = Clock::now();
        const std::uint32_t done = visit(BrickBatch{first, std::min(bricks - first, most)});
        const std::chrono::duration<double> spent = Clock::now() - start;
        first += done;
        const double next = done * kBatchSeconds / std::max(spent.count(), 1e-6);
        most = static_cast<std::uint32_t>(
            std::clamp(next, 1.0, double(std::min(most * kBatchGrowth, kBatchBricks))));
        if (progress) {
            progress(share.from + (share.to - share.from) * first / bricks);
        }
    }
}

}  // namespace nightcity
