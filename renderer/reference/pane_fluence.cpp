// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "reference/pane_fluence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace nightcity {

namespace {

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

// Van Oosterom and Strackee 1983. `height` (m): of the eye off the pane's plane.
double triangleSolidAngle(const LitWindow& window, glm::dvec3 eye, double height, glm::dvec2 a,
                          glm::dvec2 b, glm::dvec2 c) {
    const glm::dvec3 toA = window.at(a) - eye, toB = window.at(b) - eye, toC = window.at(c) - eye;
    const double lengthA = glm::length(toA), lengthB = glm::length(toB), lengthC = glm::length(toC);
    const double volume = height * glm::length(window.halfU) * glm::length(window.halfV) *
                          std::abs(cross(b - a, c - a));
    return 2 * std::atan2(volume, lengthA * lengthB * lengthC + glm::dot(toA, toB) * lengthC +
                                      glm::dot(toB, toC) * lengthA + glm::dot(toC, toA) * lengthB);
}

// A triangle of the pane: its solid angle times the mean transmittance.
struct Cell {
    std::array<glm::dvec2, 3> corner;
    Estimate estimate;
};

class Dimming {
public:
    Dimming(const LitWindow& window, glm::dvec3 eye, const HazeBetween& haze, double relative)
        : window_(window),
          eye_(eye),
          haze_(haze),
          relative_(relative),
          height_(std::abs(glm::dot(window.normal, eye - window.centre))),
          sizeU_(glm::length(window.halfU)),
          sizeV_(glm::length(window.halfV)) {}

    // The mean by three points, exact to the second degree (Strang and Fix 1973), where
    // that is enough; else by Radon's seven, exact to the fifth. What these miss of a
    // kink, where hazes meet on the way, is not in the error.
    Cell cell(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) const {
        const std::array<glm::dvec2, 3> corner{a, b, c};
        const glm::dvec2 centre = (a + b + c) / 3.0;
        const double size = std::max({length(b - a), length(c - b), length(a - c)});
        const double distance = glm::length(window_.at(centre) - eye_);
        const double tilt = size / distance;
        const double variation = haze_.largestExtinction() * size;
        Mean mean = threePoints(corner, centre);
        double error = threePointError(tilt, variation);
        const double bend = haze_.isUniform() ? 0
                                              : std::abs(extinctionTo(centre) -
                                                         mean.extinction / mean.weight);
        if (error + kKinkShare * bend * distance > relative_) {
            mean = sevenPoints(corner, centre);
            error = sevenPointError(tilt, variation);
        }
        const double value =
            triangleSolidAngle(window_, eye_, height_, a, b, c) * (mean.sum / mean.weight);
        return {corner, {value, error * value}};
    }

private:
    // Of the transmittance and of the mean extinction on the way to each place. A
    // place weighs what it adds to the solid angle, up to a factor.
    struct Mean {
        double sum = 0, extinction = 0, weight = 0;
    };
    // Where hazes meet on the way the extinction has kinks, and the centre differs from
    // the mean: by this much of it three points may be off.
    static constexpr double kKinkShare = 0.3;

    Mean threePoints(const std::array<glm::dvec2, 3>& corner, glm::dvec2 centre) const {
        Mean mean;
        for (const glm::dvec2 at : corner) {
            add(mean, centre + 0.5 * (at - centre), 1.0 / 3);
        }
        return mean;
    }

    Mean sevenPoints(const std::array<glm::dvec2, 3>& corner, glm::dvec2 centre) const {
        Mean mean;
        add(mean, centre, 0.225);
        for (const glm::dvec2 at : corner) {
            add(mean, centre + 0.696140478029631 * (at - centre), 0.125939180544827153);
            add(mean, centre - 0.410426192314534 * (at - centre), 0.132394152788506181);
        }
        return mean;
    }

    double extinctionTo(glm::dvec2 uv) const { return haze_.depth(eye_, window_.at(uv), 1); }

    double length(glm::dvec2 uv) const { return std::hypot(uv.x * sizeU_, uv.y * sizeV_); }

    void add(Mean& mean, glm::dvec2 uv, double share) const {
        const glm::dvec3 place = window_.at(uv);
        const double d = glm::length(place - eye_);
        const double weight = share / (d * d * d);
        const double extinction = haze_.depth(eye_, place, 1);
        mean.weight += weight;
        mean.extinction += weight * extinction;
        mean.sum += weight * std::exp(-extinction * d);
    }

    // Of the mean transmittance of a triangle, relative, by its size over the distance
    // and its size in optical depth: above the worst of 100,000 random triangles.
    static double threePointError(double tilt, double variation) {
        return variation *
               (0.045 * tilt * tilt + 0.005 * tilt * variation + 0.0007 * variation * variation);
    }
    static double sevenPointError(double tilt, double variation) {
        const double both = tilt + 0.2 * variation, squared = both * both;
        return 0.015 * variation * squared * squared * both;
    }

    const LitWindow& window_;
    glm::dvec3 eye_;
    const HazeBetween& haze_;
    double relative_;
    double height_;
    double sizeU_, sizeV_;
};

Estimate sumOf(const std::vector<Cell>& cells) {
    Estimate total;
    for (const Cell& cell : cells) {
        total += cell.estimate;
    }
    return total;
}

// Cuts the cell with the largest error in four until the sum of all holds.
Estimate refined(const Dimming& dimming, std::vector<Cell> cells, const Tolerance& tolerance) {
    constexpr std::size_t kMostCells = 20000;
    const auto smaller = [](const Cell& a, const Cell& b) {
        return a.estimate.error < b.estimate.error;
    };
    Estimate total = sumOf(cells);
    if (total.error <= tolerance.of(total.value)) {
        return total;
    }
    std::make_heap(cells.begin(), cells.end(), smaller);
    while (total.error > tolerance.of(total.value) && cells.size() < kMostCells) {
        std::pop_heap(cells.begin(), cells.end(), smaller);
        const Cell worst = cells.back();
        cells.pop_back();
        total.value -= worst.estimate.value;
        total.error -= worst.estimate.error;
        const auto [a, b, c] = worst.corner;
        const glm::dvec2 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
        for (const Cell& cell : {dimming.cell(a, ab, ca), dimming.cell(ab, b, bc),
                                 dimming.cell(ca, bc, c), dimming.cell(bc, ca, ab)}) {
            total += cell.estimate;
            cells.push_back(cell);
            std::push_heap(cells.begin(), cells.end(), smaller);
        }
    }
    return sumOf(cells);  // afresh: no drift
}

// visit(a, b, c) for every triangle of the parts.
template <typename Visit>
void visitTriangles(const PanePolygons& parts, Visit&& visit) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto part = parts[i];
        for (std::size_t k = 2; k < part.size(); ++k) {
            visit(part[0], part[k - 1], part[k]);
        }
    }
}

}  // namespace

double solidAngle(const LitWindow& window, const PanePolygons& parts, glm::dvec3 eye) {
    const double height = std::abs(glm::dot(window.normal, eye - window.centre));
    double sum = 0;
    visitTriangles(parts, [&](glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
        sum += triangleSolidAngle(window, eye, height, a, b, c);
    });
    return sum;
}

Estimate dimmedSolidAngle(const LitWindow& window, const PanePolygons& parts, glm::dvec3 eye,
                          const HazeBetween& haze, double relative) {
    if (haze.largestExtinction() == 0) {
        return {solidAngle(window, parts, eye), 0};
    }
    const Dimming dimming(window, eye, haze, relative);
    std::vector<Cell> cells;
    visitTriangles(parts, [&](glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
        cells.push_back(dimming.cell(a, b, c));
    });
    return refined(dimming, std::move(cells), {0, relative});
}

}  // namespace nightcity
