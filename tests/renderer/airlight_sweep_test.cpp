// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The tolerance that is asked for is kept, on random cases against double precision; and
// at what cost. airlight_table does the same on a million cases.
#include <cmath>

#include <gtest/gtest.h>

#include "airlight_cases.h"

namespace nightcity {
namespace {

constexpr int kCases = 40000;

struct Sweep {
    std::vector<PointCase> cases;
    std::vector<double> exact;

    Sweep(std::uint64_t seed, bool lambertian, PointCase (*draw)(RandomNumbers&)) {
        RandomNumbers random(seed);
        for (int k = 0; k < kCases; ++k) {
            const PointCase c = draw(random);
            const double value = lambertian ? exactLambertian(c) : exactIsotropic(c);
            if (value > 1e-30) {
                cases.push_back(c);
                exact.push_back(value);
            }
        }
    }

    template <typename Formula>
    ErrorFigures errors(Formula&& formula) const {
        std::vector<double> errors;
        for (std::size_t k = 0; k < cases.size(); ++k) {
            const double error = std::abs(formula(cases[k]) / exact[k] - 1);
            errors.push_back(std::isnan(error) ? 1e30 : error);
        }
        return errorFigures(errors);
    }
};

double isotropic(const PointCase& c, float tolerance) {
    return airlightIsotropic(c.interval, c.extinction, tolerance);
}

double lambertian(const PointCase& c, float tolerance) {
    return airlightLambertian(c.interval, c.direction, c.normal, c.extinction, tolerance);
}

TEST(AirlightSweep, IsotropicKeepsItsTolerance) {
    const Sweep sweep(11, false, randomPointCase);
    for (const float tolerance : {0.1f, 0.03f, 0.01f, 0.003f, 0.001f}) {
        const ErrorFigures e =
            sweep.errors([&](const PointCase& c) { return isotropic(c, tolerance); });
        EXPECT_LT(e.max, tolerance);
        EXPECT_LT(e.p50, 4e-3 * tolerance);
    }
    const ErrorFigures e = sweep.errors([](const PointCase& c) { return isotropic(c, 1e-4f); });
    EXPECT_LT(e.p999, 1e-4);
    EXPECT_LT(e.max, 2e-4);
}

TEST(AirlightSweep, LambertianKeepsItsTolerance) {
    const Sweep sweep(12, true, randomPointCase);
    for (const float tolerance : {0.1f, 0.03f, 0.01f, 0.003f, 0.001f}) {
        const ErrorFigures e =
            sweep.errors([&](const PointCase& c) { return lambertian(c, tolerance); });
        EXPECT_LT(e.p999, tolerance);
        EXPECT_LT(e.max, 3 * tolerance);
        EXPECT_LT(e.p50, 4e-3 * tolerance);
    }
    const ErrorFigures e = sweep.errors([](const PointCase& c) { return lambertian(c, 1e-4f); });
    EXPECT_LT(e.p99, 1e-4);
}

TEST(AirlightSweep, OneToTwoNodesInAStreet) {
    for (const bool lobe : {false, true}) {
        const Sweep sweep(13, lobe, randomStreetCase);
        const float tolerance = 0.01f;
        double nodes = 0;
        for (const PointCase& c : sweep.cases) {
            nodes += nodesTaken(c, lobe, tolerance);
        }
        EXPECT_LT(nodes / double(sweep.cases.size()), 1.7);
        const ErrorFigures e = sweep.errors([&](const PointCase& c) {
            return lobe ? lambertian(c, tolerance) : isotropic(c, tolerance);
        });
        EXPECT_LT(e.max, tolerance);
        EXPECT_LT(e.p50, 0.2 * tolerance);
    }
}

// A node too few would be seen: the sweeps are no formality.
TEST(AirlightSweep, OneNodeAloneBreaksTheTolerance) {
    const Sweep sweep(11, false, randomPointCase);
    const ErrorFigures e = sweep.errors([](const PointCase& c) {
        const AirlightInterval& i = c.interval;
        const float middle = i.span * i.da / (i.da + i.db);
        return airlightArc(i) / i.h *
               airlightAttenuation(i, c.extinction, middle, airlightDistance(i, middle));
    });
    EXPECT_GT(e.p99, 0.1);
}

}  // namespace
}  // namespace nightcity
