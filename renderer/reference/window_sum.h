// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The sum over all windows to a stated error: the brightest bounds first, the work
// shared out by them, the rest left out once its bound no longer matters.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "reference/adaptive_quadrature.h"
#include "reference/emitters.h"

namespace nightcity {

// What a value may be off by, as a fraction of it.
struct Accuracy {
    double relative = 1e-4;
    double leftOut = 1e-6;  // windows that together bring less than this are skipped
};

// Errors are those of the mean of the channels.
struct WindowSum {
    glm::dvec3 value{0};
    double error = 0;    // estimated bound of the quadrature, absolute
    double leftOut = 0;  // bound of what the skipped windows bring, absolute
    std::uint64_t windows = 0;  // integrated
};

struct WindowBound {
    std::uint32_t window;  // into the lit windows
    double bound;          // of the mean of the channels: never below what it brings
};

// perWatt(window index, tolerance) is the integral of one window. The order, and so
// the result to the bit, depends on nothing but the arguments.
template <typename PerWatt>
WindowSum sumWindows(const std::vector<LitWindow>& windows, std::vector<WindowBound> bounds,
                     const Accuracy& accuracy, PerWatt&& perWatt) {
    std::stable_sort(bounds.begin(), bounds.end(),
                     [](const WindowBound& a, const WindowBound& b) { return a.bound > b.bound; });
    std::vector<double> rest(bounds.size() + 1, 0.0);  // of a window and all after it
    for (std::size_t i = bounds.size(); i-- > 0;) {
        rest[i] = rest[i + 1] + bounds[i].bound;
    }
    WindowSum sum;
    double mean = 0;  // of the channels, so far: whatever is to come adds to it
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        if (rest[i] <= accuracy.leftOut * mean) {
            sum.leftOut = rest[i];
            break;
        }
        const LitWindow& window = windows[bounds[i].window];
        const double power = window.meanPower();
        // By its bound, and an equal one: far windows need not be finer than they matter.
        const double share = 0.5 * (bounds[i].bound / rest[0] + 1 / double(bounds.size()));
        const Tolerance tolerance{0.5 * accuracy.relative * mean * share / power,
                                  0.5 * accuracy.relative};
        const Estimate estimate = perWatt(bounds[i].window, tolerance);
        sum.value += estimate.value * window.power;
        sum.error += estimate.error * power;
        mean += estimate.value * power;
        ++sum.windows;
    }
    return sum;
}

}  // namespace nightcity
