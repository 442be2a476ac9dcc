// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Prints what the air-light formulas cost and how far they are off:
//
//     airlight_table [cases, 1000000]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>
#include <string>

#include "airlight_cases.h"

namespace nightcity {

namespace {

using Formula = std::function<double(std::size_t)>;

void printErrors(const char* name, double tolerance, const std::vector<double>& exact,
                 const Formula& formula) {
    std::vector<double> errors;
    std::size_t over = 0;
    for (std::size_t k = 0; k < exact.size(); ++k) {
        errors.push_back(std::abs(formula(k) / exact[k] - 1));
        over += !(errors.back() <= tolerance);
    }
    const ErrorFigures figures = errorFigures(errors);
    std::printf("%-22s %8g %9zu  %8.1e %8.1e %8.1e %8.1e %9.5f %%\n", name, tolerance,
                errors.size(), figures.p50, figures.p99, figures.p999, figures.max,
                100.0 * double(over) / double(errors.size()));
}

// Cases whose value is not so small that float has no digits left for it.
template <typename Case>
void keepVisible(std::vector<Case>& cases, std::vector<double>& exact) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < cases.size(); ++k) {
        if (exact[k] > 1e-30) {
            cases[kept] = cases[k];
            exact[kept++] = exact[k];
        }
    }
    cases.resize(kept);
    exact.resize(kept);
}

void pointErrors(const char* name, std::size_t count, PointCase (*draw)(RandomNumbers&)) {
    for (const bool lambertian : {false, true}) {
        RandomNumbers random(7);
        std::vector<PointCase> cases;
        std::vector<double> exact;
        for (std::size_t k = 0; k < count; ++k) {
            cases.push_back(draw(random));
            exact.push_back(lambertian ? exactLambertian(cases.back())
                                       : exactIsotropic(cases.back()));
        }
        keepVisible(cases, exact);
        const std::string label = std::string(name) + (lambertian ? " lambertian" : " isotropic");
        for (const float tolerance : {0.1f, 0.03f, 0.01f, 0.003f, 0.001f, 1e-4f}) {
            printErrors(label.c_str(), tolerance, exact, [&](std::size_t k) {
                const PointCase& c = cases[k];
                return lambertian ? airlightLambertian(c.interval, c.direction, c.normal,
                                                       c.extinction, tolerance)
                                  : airlightIsotropic(c.interval, c.extinction, tolerance);
            });
        }
    }
}

float paneValue(const PaneCase& c, float tolerance) {
    return airlightPane(c.fromCentre, c.direction, c.halfU, c.halfV, c.begin, c.end, c.extinction,
                        tolerance);
}

void paneErrors(std::size_t count, double extinction) {
    RandomNumbers random(8);
    std::vector<PaneCase> cases;
    std::vector<double> exact;
    for (std::size_t k = 0; k < count; ++k) {
        cases.push_back(randomPaneCase(random, extinction));
        exact.push_back(exactPane(cases.back()));
    }
    keepVisible(cases, exact);
    char label[40];
    std::snprintf(label, sizeof label, "pane tau %g", extinction);
    for (const float tolerance : {0.1f, 0.03f, 0.01f, 0.003f, 0.001f}) {
        printErrors(label, tolerance, exact,
                    [&](std::size_t k) { return paneValue(cases[k], tolerance); });
    }
}

double secondsEach(std::size_t count, const Formula& formula) {
    volatile double sink = 0;
    const std::clock_t start = std::clock();  // processor time: the machine may be shared
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) {
        sum += formula(k);
    }
    sink = sum;
    static_cast<void>(sink);
    return double(std::clock() - start) / double(CLOCKS_PER_SEC) / double(count);
}

void costs(std::size_t count, const char* name, PointCase (*draw)(RandomNumbers&)) {
    RandomNumbers random(9);
    std::vector<PointCase> cases;
    for (std::size_t k = 0; k < count; ++k) {
        cases.push_back(draw(random));
    }
    for (const bool lambertian : {false, true}) {
        for (const float tolerance : {0.1f, 0.01f, 0.001f, 1e-4f}) {
            double total = 0;
            for (const PointCase& c : cases) {
                total += nodesTaken(c, lambertian, tolerance);
            }
            const double seconds = secondsEach(count, [&](std::size_t k) {
                const PointCase& c = cases[k];
                return lambertian ? airlightLambertian(c.interval, c.direction, c.normal,
                                                       c.extinction, tolerance)
                                  : airlightIsotropic(c.interval, c.extinction, tolerance);
            });
            std::printf("%-8s %-10s %8g  %6.2f nodes  %7.1f ns  %6.1f M/s\n", name,
                        lambertian ? "lambertian" : "isotropic", tolerance, total / double(count),
                        1e9 * seconds, 1e-6 / seconds);
        }
    }
}

// How far off a point of light in place of the pane is, by sides to the ray.
void pointForPane(std::size_t count) {
    RandomNumbers random(10);
    std::map<int, std::vector<double>> errors;  // by log2 of the sides
    for (std::size_t k = 0; k < count; ++k) {
        const PaneCase c = randomPaneCase(random, 0);
        const PaneFrame pane = paneFrame(c.fromCentre, c.direction, c.halfU, c.halfV);
        const AirlightInterval i = airlightInterval(pane.origin, pane.direction, c.begin, c.end);
        const double exact = exactPane(c);
        if (paneSides(i, pane.a, pane.b) >= 0.25f && exact > 1e-30) {
            const float point =
                airlightLambertian(i, pane.direction, vec3(0, 0, 1), c.extinction, 1e-4f);
            errors[int(std::floor(std::log2(paneSides(i, pane.a, pane.b))))].push_back(
                std::abs(point / exact - 1));
        }
    }
    std::printf("\na point for the pane, by sides between ray and pane\n");
    for (const auto& [power, list] : errors) {
        const ErrorFigures e = errorFigures(list);
        std::printf("%5g to %-5g %9zu  p50 %8.1e  p99 %8.1e  max %8.1e\n", std::exp2(power),
                    std::exp2(power + 1), list.size(), e.p50, e.p99, e.max);
    }
}

PaneCase streetPane(RandomNumbers& random) {
    const PointCase c = randomStreetCase(random);
    const glm::vec3 up(0, 0, 0.75f);
    return {c.interval.foot + c.interval.ua * c.direction, c.direction,
            glm::cross(up, c.normal) * 0.8f, up, 0, c.interval.span, c.extinction};
}

void paneCosts(std::size_t count) {
    RandomNumbers random(9);
    std::vector<PaneCase> cases;
    for (std::size_t k = 0; k < count; ++k) {
        cases.push_back(streetPane(random));
    }
    for (const float tolerance : {0.1f, 0.01f, 0.001f}) {
        const double seconds =
            secondsEach(count, [&](std::size_t k) { return paneValue(cases[k], tolerance); });
        std::printf("%-8s %-10s %8g  %12s  %7.1f ns  %6.1f M/s\n", "street", "pane", tolerance, "",
                    1e9 * seconds, 1e-6 / seconds);
    }
}

}  // namespace

void printTables(std::size_t count) {
    std::printf("relative errors    tolerance     cases       p50      p99    p99.9      max"
                "   above it\n");
    pointErrors("any", count, randomPointCase);
    pointErrors("street", count, randomStreetCase);
    paneErrors(count, 0);
    paneErrors(std::max<std::size_t>(count / 500, 100), 0.01);
    paneErrors(std::max<std::size_t>(count / 500, 100), 0.1);
    pointForPane(count);
    std::printf("\ncost\n");
    const std::size_t timed = std::max<std::size_t>(count / 4, 1000);
    costs(timed, "street", randomStreetCase);
    costs(timed, "any", randomPointCase);
    paneCosts(timed);
}

}  // namespace nightcity

int main(int argc, char** argv) {
    const long count = argc > 1 ? std::atol(argv[1]) : 1000000;
    if (argc > 2 || count < 1) {
        std::fputs("usage: airlight_table [cases]\n", stderr);
        return 2;
    }
    nightcity::printTables(std::size_t(count));
    return 0;
}
