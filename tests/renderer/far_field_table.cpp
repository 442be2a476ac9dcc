// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// What the far field of a scene costs and how far it is off, by node spacing:
//     far_field_table SCENE POINTS RADIUS CAMERA BRICKS SPACING...
// RADIUS: of the near parts, m. CAMERA: about which the field is finest, or - for bricks of one
// size; BRICKS: about how many there may be. Times are of the process, over all its
// threads, then in brackets those of the passes by the clock. Errors are those of the far part at
// random places in the air, over all of the fluence there.
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include "far_field_device.h"
#include "scene/scene_file.h"
#include "scene_builder.h"

namespace nightcity {
namespace {

double processSeconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](timeval t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double quantile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[std::size_t(share * double(values.size() - 1))];
}

void printErrors(FarFieldOnDevice& device, const FlatScene& scene,
                 const FarFieldSettings& settings, const std::vector<glm::vec3>& places) {
    const auto found = device.fluence(places);
    const auto far = judgedBakedFluence(scene, settings, device.field().layout(), places, 1e-4);
    const auto all = judgedFluence(scene, settings, places, 1e-3);
    std::vector<double> total, errors;
    for (const glm::dvec3& value : all) {
        total.push_back(value.y);
    }
    const double floor = 0.01 * quantile(total, 0.5);
    double sum = 0, truth = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double error = double(found[i].y) - far[i].y;
        errors.push_back(100 * std::abs(error) / std::max(floor, all[i].y));
        sum += error;
        truth += all[i].y;
    }
    std::printf(" | %8.3f %8.3f %8.3f %8.3f %8.3f", 100 * sum / truth, quantile(errors, 0.5),
                quantile(errors, 0.95), quantile(errors, 0.99), quantile(errors, 1));
}

void printRow(FarFieldOnDevice& device, const FlatScene& scene, const FarFieldSettings& settings,
              const std::vector<glm::vec3>& places) {
    const double start = processSeconds();
    device.sync(scene, settings);
    const double baked = processSeconds();
    const std::vector<PassTime> passes = device.field().passTimes();
    std::vector<std::uint8_t> on = scene.windowsOn(1);
    std::mt19937 random(1);
    for (std::size_t i = 0; i < (on.size() + 99) / 100; ++i) {
        on[random() % on.size()] ^= 1;
    }
    const double before = processSeconds();
    device.setWindows(scene, on);
    const double toggled = processSeconds();
    device.setWindows(scene, scene.windowsOn(1));
    std::printf("%8.3f %8.3f %10llu %9.2f %9.2f %9.1f", double(settings.spacing),
                double(settings.nearRadius), static_cast<unsigned long long>(device.nodeCount()),
                baked - start, toggled - before, double(device.allocatedBytes()) / 1e6);
    if (!places.empty()) {
        printErrors(device, scene, settings, places);
    }
    for (const PassTime& pass : passes) {
        std::printf(" [%s %.2f]", pass.name.c_str(), pass.milliseconds / 1000);
    }
    std::printf("\n");
    std::fflush(stdout);
}

int run(int argc, char** argv) {
    if (argc < 7) {
        std::fprintf(stderr, "far_field_table SCENE POINTS RADIUS CAMERA BRICKS SPACING...\n");
        return 2;
    }
    const FlatScene scene = loadScene(argv[1]);
    const auto places = placesInTheAir(scene, std::size_t(std::atol(argv[2])), 5);
    FarFieldOnDevice device(false);
    FarFieldSettings settings;
    settings.memoryBytes = 4'000'000'000;
    settings.nearRadius = float(std::atof(argv[3]));
    device.sync(paperCity(1).load(), settings);  // compiles the shaders
    settings.mostBricks = std::strtoull(argv[5], nullptr, 10);
    if (std::string(argv[4]) != "-") {
        for (const CameraFrame& frame : scene.camera(argv[4]).frames) {
            settings.eyes.push_back(frame.position);
        }
    }
    std::printf("%8s %8s %10s %9s %9s %9s | %8s %8s %8s %8s %8s\n", "spacing", "radius", "nodes",
                "bake s", "toggle s", "MB", "bias %", "p50 %", "p95 %", "p99 %", "max %");
    for (int i = 6; i < argc; ++i) {
        settings.spacing = float(std::atof(argv[i]));
        printRow(device, scene, settings, places);
    }
    return 0;
}

}  // namespace
}  // namespace nightcity

int main(int argc, char** argv) {
    return nightcity::run(argc, argv);
}
