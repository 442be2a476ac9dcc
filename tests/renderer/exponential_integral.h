// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The closed form of the air light, by complex exponential integrals: an oracle
// that shares nothing with the judge's quadrature.
#pragma once

#include <complex>

namespace nightcity {

// E1(z) = integral from z to infinity of exp(-s) / s ds, for Re z >= 0, z not 0.
std::complex<double> exponentialIntegral(std::complex<double> z);

struct OracleValue {
    double value;
    double rounding;  // bound of what cancellation leaves of the value's digits, absolute
};

// Integral of exp(-extinction (t + d)) / d^2 dt over [begin, end], d the distance of
// t from a light at `h` > 0 from the line, its foot at `foot`. Abramowitz and Stegun
// 5.1.4, after X = (t - foot) + d: 2 exp(-extinction X) / (X^2 + h^2) dX.
OracleValue airlightOracle(double extinction, double h, double foot, double begin, double end);

}  // namespace nightcity
