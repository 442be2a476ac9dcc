// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What the far field of a scene costs and how far it is off, by node spacing:
//     far_field_table SCENE [POINTS [SPACING ...]]
// Errors are those of the far part at random places in the air, over all of the fluence there.
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "far_field_device.h"
#include "scene/scene_file.h"

using namespace nightcity;

namespace {

double processSeconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](timeval t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double quantile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values.empty() ? NAN : values[std::size_t(share * double(values.size() - 1))];
}

}  // namespace

int main(int argc, char** argv) {
    const FlatScene scene = loadScene(argv[1]);
    const std::size_t points = argc > 2 ? std::size_t(std::atol(argv[2])) : 1000;
    const std::vector<glm::vec3> places = placesInTheAir(scene, points, 5);
    FarFieldOnDevice device(false);
    std::printf("%8s %8s %10s %9s %9s %9s | %8s %8s %8s %8s %8s\n", "spacing", "radius", "nodes",
                "bake s", "toggle s", "MB", "bias %", "p50 %", "p95 %", "p99 %", "max %");
    for (int i = 3; i < std::max(argc, 4); ++i) {
        FarFieldSettings settings;
        settings.memoryBytes = 4'000'000'000;
        settings.spacing = argc > 3 ? float(std::atof(argv[i])) : 1.0f;
        const char* times = std::getenv("TIMES");
        settings.nearRadius = float(times ? std::atof(times) : 4) * settings.spacing;
        FarFieldSettings warm = settings;
        warm.spacing = 20; // compile shaders
        warm.nearRadius = 80;
        device.sync(scene, warm);
        const double start = processSeconds();
        device.sync(scene, settings);
        const double baked = processSeconds();
        std::vector<std::uint8_t> on = scene.windowsOn(1);
        std::mt19937 random(1);
        for (std::size_t k = 0; k < (on.size() + 99) / 100; ++k) {
            on[random() % on.size()] ^= 1;
        }
        device.setWindows(scene, on);
        const double toggled = processSeconds();
        device.setWindows(scene, scene.windowsOn(1));
        std::vector<double> errors;
        double sum = 0, truth = 0;
        if (points > 0) {
            const auto found = device.fluence(places);
            const auto judged = judgedFarFluence(scene, settings, places, 1e-4);
            const auto all = judgedFluence(scene, settings, places, 1e-3);
            std::vector<double> total;
            for (const glm::dvec3& value : all) {
                total.push_back(value.y);
            }
            const double floor = 0.01 * quantile(total, 0.5);
            for (std::size_t k = 0; k < places.size(); ++k) {
                const double error = (double(found[k].y) - judged[k].y) / std::max(floor, all[k].y);
                errors.push_back(std::abs(error));
                sum += found[k].y;
                truth += judged[k].y;
                if (std::getenv("WORST") && std::abs(error) > std::atof(std::getenv("WORST"))) {
                    std::printf("%g %g %g: %g for %g of %g\n", double(places[k].x), double(places[k].y),
                                double(places[k].z), double(found[k].y), judged[k].y, all[k].y);
                }
            }
        }
        std::printf("%8.3f %8.3f %10zu %9.2f %9.2f %9.1f | %8.3f %8.3f %8.3f %8.3f %8.3f\n",
                    double(settings.spacing), double(settings.nearRadius), std::size_t(device.nodeCount()),
                    baked - start, toggled - baked, double(device.allocatedBytes()) / 1e6,
                    100 * (sum / truth - 1), 100 * quantile(errors, 0.5), 100 * quantile(errors, 0.95),
                    100 * quantile(errors, 0.99), 100 * quantile(errors, 1));
    }
}
