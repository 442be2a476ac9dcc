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
#include <utility>
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

// Cells of a rectangle, the one with the largest error on top.
class RectangleCells {
public:
    template <typename Function>
    void add(Function&& f, glm::dvec2 lo, glm::dvec2 hi) {
        if (lo.x < hi.x && lo.y < hi.y) {
            push({lo, hi, productGauss(f, lo, hi)});
        }
    }

    // Cuts a cell in four at `at`. What the cut changes is an error that the rules of
    // one cell may both miss, at a kink: the children answer for it.
    template <typename Function>
    void cut(Function&& f, const RectangleCell& cell, glm::dvec2 at) {
        const glm::dvec2 lo = cell.lo, hi = cell.hi;
        std::array<RectangleCell, 4> children{{{lo, at, {}},
                                               {{at.x, lo.y}, {hi.x, at.y}, {}},
                                               {{lo.x, at.y}, {at.x, hi.y}, {}},
                                               {at, hi, {}}}};
        double sum = 0;
        for (RectangleCell& child : children) {
            child.estimate = productGauss(f, child.lo, child.hi);
            sum += child.estimate.value;
        }
        const double change =
            std::isfinite(cell.estimate.error) ? std::abs(sum - cell.estimate.value) : 0;
        const double rounding = 50 * std::numeric_limits<double>::epsilon() * std::abs(sum);
        for (RectangleCell& child : children) {
            if (change > rounding) {
                child.estimate.error = std::max(child.estimate.error, 0.25 * change);
            }
            push(child);
        }
    }

    template <typename Function>
    void cutWorst(Function&& f) {
        std::pop_heap(cells_.begin(), cells_.end(), smaller);
        const RectangleCell worst = cells_.back();
        cells_.pop_back();
        cut(f, worst, 0.5 * (worst.lo + worst.hi));
    }

    template <typename Function>
    void cutAll(Function&& f) {
        const std::vector<RectangleCell> whole = std::exchange(cells_, {});
        for (const RectangleCell& cell : whole) {
            cut(f, cell, 0.5 * (cell.lo + cell.hi));
        }
    }

    // Afresh each time: no drift, no infinity minus infinity.
    Estimate sum() const {
        Estimate total;
        for (const RectangleCell& cell : cells_) {
            total += cell.estimate;
        }
        return total;
    }
    std::size_t size() const { return cells_.size(); }

private:
    static bool smaller(const RectangleCell& a, const RectangleCell& b) {
        return a.estimate.error < b.estimate.error;
    }
    void push(const RectangleCell& cell) {
        cells_.push_back(cell);
        std::push_heap(cells_.begin(), cells_.end(), smaller);
    }

    std::vector<RectangleCell> cells_;  // a heap
};

// Integral of f(glm::dvec2) >= 0 over [-1, 1]^2, first cut at `centre` where that lies
// inside. `hasKinks()` is asked after that: where it says so every cell is cut once
// before its error is believed, and where all is 0 twice. The error is above the
// tolerance only where 20,000 cells were not enough.
template <typename Function, typename HasKinks>
Estimate integrateRectangle(Function&& f, glm::dvec2 centre, const Tolerance& tolerance,
                            HasKinks&& hasKinks) {
    constexpr std::size_t kLargestCount = 20000;
    const glm::dvec2 lo(-1), hi(1);
    RectangleCells cells;
    if (std::abs(centre.x) < 1 && std::abs(centre.y) < 1) {
        cells.add(f, lo, centre);
        cells.add(f, {centre.x, lo.y}, {hi.x, centre.y});
        cells.add(f, {lo.x, centre.y}, {centre.x, hi.y});
        cells.add(f, centre, hi);
    } else {
        cells.add(f, lo, hi);
    }
    if (hasKinks()) {
        cells.cutAll(f);
        if (cells.sum().value == 0) {
            cells.cutAll(f);
        }
    }
    Estimate total = cells.sum();
    while (!(total.error <= tolerance.of(total.value)) && cells.size() < kLargestCount) {
        const std::size_t round = std::max<std::size_t>(1, cells.size() / 16);
        for (std::size_t i = 0; i < round; ++i) {
            cells.cutWorst(f);
        }
        total = cells.sum();
    }
    return total;
}

}  // namespace nightcity
