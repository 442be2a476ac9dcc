// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "exponential_integral.h"

#include <cmath>
#include <numbers>

namespace nightcity {

namespace {

using Complex = std::complex<double>;

// Abramowitz and Stegun 5.1.11.
Complex series(Complex z) {
    Complex sum = 0, term = 1;
    for (int n = 1; n < 200; ++n) {
        term *= -z / double(n);
        sum -= term / double(n);
        if (std::abs(term) < 1e-18 * std::abs(sum)) {
            break;
        }
    }
    return -std::numbers::egamma - std::log(z) + sum;
}

// exp(z) E1(z) by Lentz's method on the even part of 5.1.22.
Complex scaledFraction(Complex z) {
    Complex b = z + 1.0, c = 1e300, d = 1.0 / b, h = d;
    for (int n = 1; n < 10000; ++n) {
        const double a = -double(n) * n;
        b += 2.0;
        d = 1.0 / (a * d + b);
        c = b + a / c;
        h *= c * d;
        if (std::abs(c * d - 1.0) < 1e-16) {
            break;
        }
    }
    return h;
}

}  // namespace

Complex exponentialIntegral(Complex z) {
    return std::abs(z) < 2 ? series(z) : std::exp(-z) * scaledFraction(z);
}

OracleValue airlightOracle(double extinction, double h, double foot, double begin, double end) {
    const auto term = [&](double t) {
        const double u = t - foot, d = std::hypot(h, u);
        const double x = u < 0 ? h * h / (d - u) : u + d;
        const Complex z = extinction * Complex(x, -h);
        return std::exp(Complex(-extinction * foot, -extinction * h)) * exponentialIntegral(z);
    };
    const Complex a = term(begin), b = term(end);
    return {2 / h * (a - b).imag(), 2 / h * 1e-14 * (std::abs(a) + std::abs(b))};
}

}  // namespace nightcity
