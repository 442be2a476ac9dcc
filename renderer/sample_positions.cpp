// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
#include "sample_positions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nightcity {

namespace {

constexpr double kGaussSigma = 0.5;   // pixels
constexpr double kGaussRadius = 1.5;  // pixels, where the Gaussian is cut off

double fraction(double value) {
    return value - std::floor(value);
}

// Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators":
// the finalizer of SplitMix64. Maps 0 to 0, so that seed 0 does not shift.
std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

// Point of the R2 sequence (Roberts 2018, "The unreasonable effectiveness of
// quasirandom sequences"): multiples of 1/g and 1/g^2 modulo 1, where g is the
// real root of g^3 = g + 1.
glm::dvec2 sequencePoint(std::uint32_t index, glm::dvec2 shift) {
    constexpr double g = 1.32471795724474602596;
    const double n = index;
    return {fraction(0.5 + shift.x + n / g), fraction(0.5 + shift.y + n / (g * g))};
}

// Inverts the radial distribution of a Gaussian cut off at kGaussRadius:
// F(r) = (1 - exp(-r^2 / 2 sigma^2)) / (1 - exp(-R^2 / 2 sigma^2)).
glm::dvec2 warpGauss(glm::dvec2 u) {
    const double scale = 2 * kGaussSigma * kGaussSigma;
    const double inside = 1 - std::exp(-kGaussRadius * kGaussRadius / scale);
    const double r = std::sqrt(-scale * std::log1p(-u.x * inside));
    const double angle = 2 * std::numbers::pi * u.y;
    return {r * std::cos(angle), r * std::sin(angle)};
}

}  // namespace

std::vector<glm::vec2> samplePositions(const RenderSettings& settings) {
    if (settings.pixelSamples <= 1) {
        return {glm::vec2(0)};
    }
    const std::uint64_t first = mix(settings.seed);
    const std::uint64_t second = mix(first);
    const glm::dvec2 shift(std::ldexp(double(first >> 11), -53), std::ldexp(double(second >> 11), -53));
    std::vector<glm::vec2> positions;
    positions.reserve(settings.pixelSamples);
    for (std::uint32_t i = 0; i < settings.pixelSamples; ++i) {
        const glm::dvec2 u = sequencePoint(i, shift);
        positions.emplace_back(settings.filter == Filter::gauss ? warpGauss(u) : u - 0.5);
    }
    return positions;
}

std::size_t centreSample(std::span<const glm::vec2> positions) {
    const auto nearer = [](glm::vec2 a, glm::vec2 b) { return glm::dot(a, a) < glm::dot(b, b); };
    return std::size_t(std::min_element(positions.begin(), positions.end(), nearer) -
                       positions.begin());
}

}  // namespace nightcity
