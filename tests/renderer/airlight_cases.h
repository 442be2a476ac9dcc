// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Random air-light integrals and their values in double precision, for the tests and
// the tables of shaders/transport/airlight*.h.
#pragma once

#include <random>
#include <vector>

#include <glm/glm.hpp>

#include "transport/airlight_pane.h"

namespace nightcity {

// The same numbers with every standard library.
class RandomNumbers {
public:
    explicit RandomNumbers(std::uint64_t seed) : bits_(seed) {}

    double between(double low, double high);
    double logBetween(double low, double high);  // of constant density in the logarithm
    glm::dvec3 direction();

private:
    std::mt19937_64 bits_;
};

struct PointCase {
    AirlightInterval interval;
    glm::vec3 direction;
    glm::vec3 normal;
    float extinction;  // 1/m
};

struct PaneCase {
    glm::vec3 fromCentre;  // m, the ray's origin less the pane's centre
    glm::vec3 direction;
    glm::vec3 halfU, halfV;
    float begin, end;      // m
    float extinction;      // 1/m
};

// The interval of a ray whose foot is h m from the emitter, towards `across`, from ua m
// after the foot; rounded to float once.
AirlightInterval exactInterval(double h, glm::dvec3 across, double ua, double span, double begin);

// Lengths 0.01 to 2000 m, h 1e-6 to 300 m, extinction 0 (one in ten) or 1e-4 to 10 /m, the foot
// before, inside and behind, any direction of the lobe.
PointCase randomPointCase(RandomNumbers& random);

// A chord of a street of the paper's city (10 x 10 x 30 m, extinction 0.01 /m) and one of
// the 40 windows of the two facades along it.
PointCase randomStreetCase(RandomNumbers& random);

// A ray that passes a pane of 1 m^2 (aspect 1 to 4) at 0.005 to 20 m; a third of them graze.
PaneCase randomPaneCase(RandomNumbers& random, double extinction);

// Relative error below 1e-7.
double exactIsotropic(const PointCase& c);
double exactLambertian(const PointCase& c);
// Relative error below 1e-6 at extinction 0; else below 1e-4, and slow.
double exactPane(const PaneCase& c);

// The nodes that airlightIsotropic or airlightLambertian takes.
int nodesTaken(const PointCase& c, bool lambertian, float tolerance);

struct ErrorFigures {
    double p50, p99, p999, max;
};

// Of at least one error.
ErrorFigures errorFigures(std::vector<double> errors);

}  // namespace nightcity
