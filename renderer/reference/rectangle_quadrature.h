// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Quadrature over a rectangle to a tolerance: product Gauss rules, the worst cell
// cut in four until the error holds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/glm.hpp>

#include "reference/adaptive_quadrature.h"

namespace nightcity {

struct RectangleCell {
    glm::dvec2 lo, hi;
    Estimate estimate;
};

// Mean of f over the cell, times its area: 3 x 3 Gauss nodes, judged by 2 x 2.
// A value that is not finite makes the error infinite: cut the cell.
template <typename Function>
Estimate productGauss(Function&& f, glm::dvec2 lo, glm::dvec2 hi) {
    constexpr double kTwo = 0.57735026918962576451;    // sqrt(1/3)
    constexpr double kThree = 0.77459666924148337704;  // sqrt(3/5)
    const glm::dvec2 centre = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
    const auto value = [&](double x, double y) { return f(centre + half * glm::dvec2(x, y)); };
    const double coarse = 0.25 * (value(-kTwo, -kTwo) + value(kTwo, -kTwo) + value(-kTwo, kTwo) +
                                  value(kTwo, kTwo));
    constexpr std::array<double, 3> kNode{-kThree, 0, kThree};
    constexpr std::array<double, 3> kWeight{5.0 / 18, 8.0 / 18, 5.0 / 18};
    double fine = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            fine += kWeight[i] * kWeight[k] * value(kNode[i], kNode[k]);
        }
    }
    const double area = (hi.x - lo.x) * (hi.y - lo.y);
    if (!std::isfinite(fine) || !std::isfinite(coarse)) {
        return {0, std::numeric_limits<double>::infinity()};
    }
    const double difference = std::abs(fine - coarse);
    const double rounding = 50 * std::numeric_limits<double>::epsilon() * std::abs(fine);
    return {area * fine, difference <= rounding ? 0 : area * difference};
}

// Integral of f(glm::dvec2) >= 0 over [-1, 1]^2, first cut at `centre` where that lies
// inside. Where all nodes of the first cells are 0, a grid of 4 x 4 cells looks again.
// The error is above the tolerance only where 20,000 cells were not enough.
template <typename Function>
Estimate integrateRectangle(Function&& f, glm::dvec2 centre, const Tolerance& tolerance) {
    constexpr std::size_t kLargestCount = 20000;
    std::vector<RectangleCell> cells;
    const auto smaller = [](const RectangleCell& a, const RectangleCell& b) {
        return a.estimate.error < b.estimate.error;
    };
    const auto add = [&](glm::dvec2 lo, glm::dvec2 hi) {
        if (lo.x < hi.x && lo.y < hi.y) {
            cells.push_back({lo, hi, productGauss(f, lo, hi)});
            std::push_heap(cells.begin(), cells.end(), smaller);
        }
    };
    const auto cut = [&](glm::dvec2 lo, glm::dvec2 hi, glm::dvec2 at) {
        add(lo, at);
        add({at.x, lo.y}, {hi.x, at.y});
        add({lo.x, at.y}, {at.x, hi.y});
        add(at, hi);
    };
    const bool inside = std::abs(centre.x) < 1 && std::abs(centre.y) < 1;
    if (inside) {
        cut(glm::dvec2(-1), glm::dvec2(1), centre);
    } else {
        add(glm::dvec2(-1), glm::dvec2(1));
    }
    const auto sum = [&] {
        Estimate total;
        for (const RectangleCell& cell : cells) {
            total += cell.estimate;
        }
        return total;
    };
    Estimate total = sum();
    if (total.value == 0 && total.error == 0) {
        cells.clear();
        for (int i = 0; i < 16; ++i) {
            const glm::dvec2 lo = glm::dvec2(i % 4, i / 4) * 0.5 - 1.0;
            add(lo, lo + 0.5);
        }
        total = sum();
    }
    while (!(total.error <= tolerance.of(total.value)) && cells.size() < kLargestCount) {
        // In rounds, so that summing afresh (no drift, no infinity minus infinity) is cheap.
        const std::size_t round = std::max<std::size_t>(1, cells.size() / 16);
        for (std::size_t i = 0; i < round; ++i) {
            std::pop_heap(cells.begin(), cells.end(), smaller);
            const RectangleCell worst = cells.back();
            cells.pop_back();
            cut(worst.lo, worst.hi, 0.5 * (worst.lo + worst.hi));
        }
        total = sum();
    }
    return total;
}

}  // namespace nightcity
