// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The air-light headers as GLSL, on the device: the same numbers as in C++, and the same
// tolerance kept. (Counts of nodes may differ where two logarithms round differently.)
#include <cmath>

#include <gtest/gtest.h>

#include "airlight_cases.h"
#include "airlight_query.h"
#include "airlight_spirv.h"
#include "gpu/commands.h"
#include "gpu/compute_pipeline.h"
#include "gpu/instance.h"
#include "gpu/physical_device.h"
#include "gpu/readable_buffer.h"

namespace nightcity {
namespace {

constexpr int kQueries = 8192;
constexpr float kTolerance = 0.01f;

std::vector<AirlightAnswer> onDevice(const std::vector<AirlightQuery>& queries) {
    gpu::Instance instance(true);
    gpu::Device device(instance.get(), gpu::chooseDevice(gpu::describeDevices(instance.get()), ""));
    gpu::Commands commands(device);
    const uint64_t bytes = queries.size() * sizeof(AirlightQuery);
    gpu::Buffer source(device, "queries", bytes, gpu::MemoryKind::device);
    commands.upload(source, queries.data(), bytes);
    const gpu::ReadableBuffer target(device, "answers", queries.size() * sizeof(AirlightAnswer));
    const gpu::Binding in{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    const gpu::Binding out{1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    gpu::ComputePipeline pipeline(device, {"airlight", kAirlightSpirv, {in, out}, 0, {}});
    pipeline.bindBuffers(in, source, bytes);
    pipeline.bindBuffers(out, target.buffer(), target.bytes());
    commands.run("airlight", [&](VkCommandBuffer recording) {
        pipeline.dispatch(recording, nullptr, uint32_t(queries.size() + 255) / 256);
        gpu::computeBarrier(recording);
        target.recordReadback(recording);
    });
    instance.throwIfMessages();
    const auto* answers = static_cast<const AirlightAnswer*>(target.data());
    return {answers, answers + queries.size()};
}

struct Difference {
    std::vector<double> fromHost, fromExact;

    void add(double device, double host, double exact) {
        if (exact > 1e-30) {
            fromHost.push_back(std::abs(device / host - 1));
            fromExact.push_back(std::isnan(device) ? 1e30 : std::abs(device / exact - 1));
        }
    }
    void expectSmall() const {
        EXPECT_LT(errorFigures(fromHost).p50, 1e-6);
        EXPECT_LT(errorFigures(fromExact).p99, kTolerance);
        EXPECT_LT(errorFigures(fromExact).max, 1.5 * kTolerance);
    }
};

TEST(AirlightOnDevice, AgreesWithTheHostAndKeepsItsTolerance) {
    RandomNumbers random(31);
    std::vector<AirlightQuery> queries;
    std::vector<PointCase> points;
    std::vector<PaneCase> panes;
    for (int k = 0; k < kQueries; ++k) {
        points.push_back(randomPointCase(random));
        panes.push_back(randomPaneCase(random, 0));
        const PointCase& c = points.back();
        const PaneCase& p = panes.back();
        queries.push_back({c.interval, c.direction, c.normal, p.fromCentre, p.halfU, p.halfV,
                           p.end, c.extinction, kTolerance});
        panes.back().direction = c.direction;
        panes.back().extinction = c.extinction;
    }
    const std::vector<AirlightAnswer> answers = onDevice(queries);
    Difference isotropic, lambertian;
    std::vector<double> pane;
    for (std::size_t k = 0; k < queries.size(); ++k) {
        const AirlightQuery& q = queries[k];
        isotropic.add(answers[k].isotropic,
                      airlightIsotropic(q.interval, q.extinction, q.tolerance),
                      exactIsotropic(points[k]));
        lambertian.add(answers[k].lambertian,
                       airlightLambertian(q.interval, q.direction, q.normal, q.extinction,
                                          q.tolerance),
                       exactLambertian(points[k]));
        const double host = airlightPane(q.fromCentre, q.direction, q.halfU, q.halfV, 0, q.end,
                                         q.extinction, q.tolerance);
        if (host > 1e-30) {
            const double error = std::abs(answers[k].pane / host - 1);
            pane.push_back(std::isnan(error) ? 1e30 : error);
        }
    }
    isotropic.expectSmall();
    lambertian.expectSmall();
    EXPECT_GT(pane.size(), kQueries / 4);
    EXPECT_LT(errorFigures(pane).p50, 1e-5);
    EXPECT_LT(errorFigures(pane).p99, kTolerance);
}

}  // namespace
}  // namespace nightcity
