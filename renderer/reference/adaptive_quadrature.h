// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// One-dimensional quadrature to a tolerance: Gauss-Kronrod rules of QUADPACK
// (Piessens et al. 1983), the worst piece halved until the error holds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace nightcity {

struct Estimate {
    double value = 0;
    double error = 0;  // estimated bound, absolute, not negative

    Estimate& operator+=(const Estimate& other) {
        value += other.value;
        error += other.error;
        return *this;
    }
};

// What an integral may be off by: the larger of the two.
struct Tolerance {
    double absolute = 0;
    double relative = 0;  // of the value

    double of(double value) const { return std::max(absolute, relative * std::abs(value)); }
};

// The part of a range between two break points.
struct QuadraturePiece {
    double begin = 0;
    double end = 0;
    Estimate estimate;
};

// Kronrod nodes on (0, 1], their weights, and the weights of the embedded Gauss rule
// (0 where it has no node). The last entry is the centre.
template <std::size_t Count>
struct KronrodRule {
    std::array<double, Count> node;
    std::array<double, Count> weight;
    std::array<double, Count> gaussWeight;
};
// 15 points about 7: for long smooth pieces.
inline constexpr KronrodRule<8> kKronrod15{
    {0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
     0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
     0.586087235467691130294144691693305, 0.405845151377397166906606412076961,
     0.207784955007898467600689403773245, 0.0},
    {0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
     0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
     0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
     0.204432940075298892414161999234649, 0.209482141084727828012999174891714},
    {0.0, 0.129484966168869693270611432679082, 0.0, 0.279705391489276667901467771423780, 0.0,
     0.381830050505118944950369775488975, 0.0, 0.417959183673469387755102040816327}};

// 7 points about 3: for many short pieces.
inline constexpr KronrodRule<4> kKronrod7{
    {0.960491268708020283423507092629080, 0.774596669241483377035853079956480,
     0.434243749346802558002071502844628, 0.0},
    {0.104656226026467265193823857192073, 0.268488089868333440728569280666710,
     0.401397414775962222905051818618432, 0.450916538658474142345110087045571},
    {0.0, 0.555555555555555555555555555555556, 0.0, 0.888888888888888888888888888888889}};

// The error is the difference of the two rules, far above the true one of the
// Kronrod rule; differences that rounding explains count as none.
template <std::size_t Count, typename Function>
Estimate kronrod(const KronrodRule<Count>& rule, Function&& f, double begin, double end) {
    const double centre = 0.5 * (begin + end);
    const double half = 0.5 * (end - begin);
    const double middle = f(centre);
    double kronrod = rule.weight.back() * middle;
    double gauss = rule.gaussWeight.back() * middle;
    double magnitude = rule.weight.back() * std::abs(middle);
    for (std::size_t i = 0; i + 1 < Count; ++i) {
        const double offset = half * rule.node[i];
        const double below = f(centre - offset);
        const double above = f(centre + offset);
        kronrod += rule.weight[i] * (below + above);
        gauss += rule.gaussWeight[i] * (below + above);
        magnitude += rule.weight[i] * (std::abs(below) + std::abs(above));
    }
    const double difference = std::abs(kronrod - gauss);
    const double rounding = 50 * std::numeric_limits<double>::epsilon() * magnitude;
    return {half * kronrod, difference <= rounding ? 0 : half * difference};
}

// Integral of f over [breaks.front(), breaks.back()], split at every break from
// the start; breaks rise. The error that is returned is above the tolerance only
// where 2,000 pieces were not enough.
template <typename Function, std::size_t Count = 8>
Estimate integrate(Function&& f, std::span<const double> breaks, const Tolerance& tolerance,
                   const KronrodRule<Count>& rule = kKronrod15) {
    constexpr std::size_t kLargestCount = 2000;
    Estimate total;
    std::vector<QuadraturePiece> pieces;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        const Estimate estimate = kronrod(rule, f, breaks[i], breaks[i + 1]);
        total += estimate;
        if (estimate.error > 0) {
            pieces.push_back({breaks[i], breaks[i + 1], estimate});
        }
    }
    if (total.error <= tolerance.of(total.value)) {
        return total;
    }
    const auto smaller = [](const QuadraturePiece& a, const QuadraturePiece& b) {
        return a.estimate.error < b.estimate.error;
    };
    std::make_heap(pieces.begin(), pieces.end(), smaller);
    for (std::size_t count = pieces.size(); count < kLargestCount && !pieces.empty(); ++count) {
        std::pop_heap(pieces.begin(), pieces.end(), smaller);
        const QuadraturePiece worst = pieces.back();
        pieces.pop_back();
        const double middle = 0.5 * (worst.begin + worst.end);
        if (middle <= worst.begin || middle >= worst.end) {
            continue;  // as narrow as numbers get: its error stays in the total
        }
        total.value -= worst.estimate.value;
        total.error -= worst.estimate.error;
        for (const auto& [begin, end] : {std::pair{worst.begin, middle}, {middle, worst.end}}) {
            const Estimate estimate = kronrod(rule, f, begin, end);
            total += estimate;
            if (estimate.error > 0) {
                pieces.push_back({begin, end, estimate});
                std::push_heap(pieces.begin(), pieces.end(), smaller);
            }
        }
        total.error = std::max(total.error, 0.0);
        if (total.error <= tolerance.of(total.value)) {
            break;
        }
    }
    return total;
}

}  // namespace nightcity
