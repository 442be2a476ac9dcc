// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Where float formulas of air light break: through the light, far away, long haze, none.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "airlight_cases.h"

namespace nightcity {
namespace {

const glm::dvec3 kAlong(1, 0, 0);
const glm::dvec3 kAcross(0, 0.6, 0.8);

PointCase pointCase(double h, double ua, double span, double extinction, double begin = 0) {
    return {exactInterval(h, kAcross, ua, span, begin), glm::vec3(kAlong),
            glm::vec3(0.48f, 0.36f, 0.8f), float(extinction)};
}

double isotropicError(const PointCase& c, float tolerance) {
    return std::abs(airlightIsotropic(c.interval, c.extinction, tolerance) / exactIsotropic(c) - 1);
}

double lambertianError(const PointCase& c, float tolerance) {
    const float value =
        airlightLambertian(c.interval, c.direction, c.normal, c.extinction, tolerance);
    return std::abs(value / exactLambertian(c) - 1);
}

TEST(Airlight, RayThroughTheLight) {
    for (double h = 1e-6; h < 1; h *= 1.3) {
        for (const double extinction : {0.0, 0.01, 1.0}) {
            const PointCase c = pointCase(h, -20, 50, extinction);
            EXPECT_LT(isotropicError(c, 0.01f), 0.01) << h << " " << extinction;
            EXPECT_LT(lambertianError(c, 0.01f), 0.01) << h << " " << extinction;
        }
    }
}

TEST(Airlight, ThroughTheLightItselfIsThroughAMicrometreBeside) {
    const vec3 direction(1, 0, 0);
    const AirlightInterval through = airlightInterval(vec3(-5, 0, 0), direction, 0, 10);
    const AirlightInterval beside = airlightInterval(vec3(-5, kAirlightNearest, 0), direction, 0, 10);
    const float value = airlightIsotropic(through, 0.01f, 0.01f);
    EXPECT_FLOAT_EQ(value, airlightIsotropic(beside, 0.01f, 0.01f));
    EXPECT_NEAR(value, std::numbers::pi / kAirlightNearest * std::exp(-0.05), 0.01 * value);
}

TEST(Airlight, AwayFromTheLightOnItsOwnLine) {
    const AirlightInterval i = airlightInterval(vec3(2, 0, 0), vec3(1, 0, 0), 0, 6);
    EXPECT_NEAR(airlightIsotropic(i, 0, 0.01f), 1.0 / 2 - 1.0 / 8, 1e-6);
}

TEST(Airlight, PerpendicularOfATenthOfAMetreAtAKilometre) {
    RandomNumbers random(2);
    double worst = 0;
    for (int k = 0; k < 10000; ++k) {
        const glm::dvec3 w = random.direction();
        const glm::dvec3 across = glm::normalize(glm::cross(w, random.direction()));
        const vec3 from(0.1 * across - 1000.0 * w), direction(w);
        const glm::dvec3 exactW = glm::normalize(glm::dvec3(direction));
        const glm::dvec3 foot = glm::dvec3(from) - glm::dot(glm::dvec3(from), exactW) * exactW;
        const AirlightInterval i = airlightInterval(from, direction, 0, 2000);
        worst = std::max(worst, std::abs(i.h / glm::length(foot) - 1));
    }
    EXPECT_LT(worst, 2e-3);  // sqrt(|q|^2 - delta^2) is off by 0.1 and more
}

TEST(Airlight, OneMetreTenKilometresAway) {
    for (const double h : {0.1, 1.0, 100.0}) {
        for (const double ua : {-10001.0, 10000.0}) {
            PointCase c = pointCase(h, ua, 1, 1e-4);
            c.normal = ua < 0 ? -c.normal : c.normal;  // towards the interval
            EXPECT_LT(isotropicError(c, 0.01f), 1e-5) << h << " " << ua;
            EXPECT_LT(lambertianError(c, 0.01f), 1e-4) << h << " " << ua;
        }
    }
}

// exp(-extinction foot) alone would be exp(200), which is no float.
TEST(Airlight, LightFarBehindTheEye) {
    for (const PointCase& c : {pointCase(1, 20, 30, 10), pointCase(1, 20000, 30, 0.01)}) {
        const float value = airlightIsotropic(c.interval, c.extinction, 0.01f);
        EXPECT_TRUE(value >= 0 && value < 1e-37f) << value;  // truly below exp(-200)
    }
    PointCase c = pointCase(1, 4000, 30, 0.01);
    EXPECT_LT(isotropicError(c, 0.01f), 0.01);
    EXPECT_LT(lambertianError(c, 0.01f), 0.01);
}

TEST(Airlight, HazeThatThinsOutToNone) {
    const PointCase clear = pointCase(2, -5, 30, 0);
    const double none = (std::atan(12.5) + std::atan(2.5)) / 2;
    EXPECT_NEAR(airlightIsotropic(clear.interval, 0, 0.01f), none, 1e-6 * none);
    for (double extinction = 1e-12; extinction < 1.1e-3; extinction *= 10) {
        const PointCase c = pointCase(2, -5, 30, extinction);
        const float value = airlightIsotropic(c.interval, c.extinction, 0.01f);
        EXPECT_NEAR(value, none, none * (1e-6 + 40 * extinction)) << extinction;
        EXPECT_LT(isotropicError(c, 0.01f), 0.01) << extinction;
        EXPECT_LT(lambertianError(c, 0.01f), 0.01) << extinction;
    }
}

TEST(Airlight, TwoHundredMeanFreePaths) {
    for (const double h : {1e-3, 0.1, 1.0, 10.0}) {
        for (const double ua : {-2000.0, -1.0, 0.0, 5.0}) {
            for (const double extinction : {0.1, 1.0, 10.0}) {
                const PointCase c = pointCase(h, ua, 200 / extinction, extinction);
                if (exactIsotropic(c) > 1e-30) {
                    EXPECT_LT(isotropicError(c, 0.01f), 0.01) << h << " " << ua;
                }
                if (exactLambertian(c) > 1e-30) {
                    EXPECT_LT(lambertianError(c, 0.01f), 0.01) << h << " " << ua;
                }
            }
        }
    }
}

TEST(Airlight, AThousandSlicesMakeTheWhole) {
    const vec3 from(-40, 0.7f, 0.2f), direction(1, 0, 0), normal(0.6f, 0.8f, 0);
    const float tolerance = 1e-5f;  // below the stated range: slices are so thin that it holds
    for (const float extinction : {0.0f, 0.01f, 0.1f}) {
        double isotropic = 0, lambertian = 0;
        for (int k = 0; k < 1000; ++k) {
            const AirlightInterval i =
                airlightInterval(from, direction, 0.1f * float(k), 0.1f * float(k + 1));
            isotropic += airlightIsotropic(i, extinction, tolerance);
            lambertian += airlightLambertian(i, direction, normal, extinction, tolerance);
        }
        const PointCase whole{airlightInterval(from, direction, 0, 100), direction, normal,
                              extinction};
        EXPECT_NEAR(isotropic / exactIsotropic(whole), 1, 1e-5) << extinction;
        EXPECT_NEAR(lambertian / exactLambertian(whole), 1, 1e-5) << extinction;
    }
}

TEST(Airlight, NoLightBehindALambertianEmitter) {
    const AirlightInterval i = airlightInterval(vec3(-5, 2, 0), vec3(1, 0, 0), 0, 10);
    EXPECT_EQ(airlightLambertian(i, vec3(1, 0, 0), vec3(0, -1, 0), 0.01f, 0.01f), 0);
    EXPECT_GT(airlightLambertian(i, vec3(1, 0, 0), vec3(0, 1, 0), 0.01f, 0.01f), 0);
    // The halves of the ray before and behind a normal along it.
    const AirlightInterval front = airlightInterval(vec3(-5, 2, 0), vec3(1, 0, 0), 5, 10);
    EXPECT_NEAR(airlightLambertian(i, vec3(1, 0, 0), vec3(1, 0, 0), 0.01f, 1e-4f),
                airlightLambertian(front, vec3(1, 0, 0), vec3(1, 0, 0), 0.01f, 1e-4f), 1e-6);
}

TEST(Airlight, OneNodeIsExactWithoutHaze) {
    RandomNumbers random(3);
    for (int k = 0; k < 1000; ++k) {
        PointCase c = randomStreetCase(random);
        c.extinction = 0;
        EXPECT_LT(isotropicError(c, 0.1f), 2e-6);
        EXPECT_LT(lambertianError(c, 0.1f), 2e-5);
        EXPECT_EQ(nodesTaken(c, true, 1e-4f), 1);
    }
}

TEST(Airlight, AnEmptyIntervalIsDark) {
    const AirlightInterval i = airlightInterval(vec3(1, 2, 3), vec3(1, 0, 0), 4, 4);
    EXPECT_EQ(airlightIsotropic(i, 0.1f, 0.01f), 0);
    EXPECT_EQ(airlightLambertian(i, vec3(1, 0, 0), vec3(0, 0, 1), 0.1f, 0.01f), 0);
    const AirlightInterval turned = airlightInterval(vec3(1, 2, 3), vec3(1, 0, 0), 4, 3);
    EXPECT_EQ(airlightIsotropic(turned, 0.1f, 0.01f), 0);
}

}  // namespace
}  // namespace nightcity
