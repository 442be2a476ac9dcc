// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The tree of occluders on the device against the judge: no face that hides anything is
// left out, and few others are named.
#include <algorithm>
#include <array>
#include <functional>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "gpu/compute_pipeline.h"
#include "gpu/instance.h"
#include "gpu/physical_device.h"
#include "gpu/readable_buffer.h"
#include "occluders_query.h"
#include "occluders_spirv.h"
#include "passes/gpu_scene.h"
#include "reference/occluders.h"
#include "reference/shadow_intervals.h"
#include "scene_builder.h"

namespace nightcity {
namespace {

constexpr int kQueries = 512;

std::vector<OccludersAnswer> onDevice(const FlatScene& scene,
                                      const std::vector<OccludersQuery>& queries) {
    gpu::Instance instance(true);
    gpu::Device device(instance.get(), gpu::chooseDevice(gpu::describeDevices(instance.get()), ""));
    gpu::Commands commands(device);
    GpuScene onGpu(device, commands);
    onGpu.syncGeometry(scene);
    onGpu.syncWindowState(scene, 1, {});
    const std::uint64_t bytes = queries.size() * sizeof(OccludersQuery);
    gpu::Buffer source(device, "queries", bytes, gpu::MemoryKind::device);
    commands.upload(source, queries.data(), bytes);
    const gpu::ReadableBuffer target(device, "answers", queries.size() * sizeof(OccludersAnswer));
    const gpu::Binding in{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    const gpu::Binding out{1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    gpu::ComputePipeline pipeline(
        device, {"occluders", kOccludersSpirv, {in, out}, sizeof(PushConstants), {}});
    pipeline.bindBuffers(in, source, bytes);
    pipeline.bindBuffers(out, target.buffer(), target.bytes());
    PushConstants push{};
    push.scene = addressWords(onGpu.tableAddress());
    commands.run("occluders", [&](VkCommandBuffer recording) {
        pipeline.dispatch(recording, &push, std::uint32_t(queries.size() + 255) / 256);
        gpu::computeBarrier(recording);
        target.recordReadback(recording);
    });
    instance.throwIfMessages();
    const auto* answers = static_cast<const OccludersAnswer*>(target.data());
    return {answers, answers + queries.size()};
}

// Two boxes, a turned prism of triangles that share no box's axes, and one face that is
// open on both sides, all about `place`.
FlatScene town(vec3 place) {
    SceneBuilder town;
    const uint material = town.addMaterial(vec3(0.5f));
    town.addBoxBuilding(place + vec3(-30, -10, 0), place + vec3(-20, 10, 25), material);
    town.addBoxBuilding(place + vec3(12, 4, 0), place + vec3(25, 20, 40), material);
    const auto base = uint(town.positions.size());
    for (const vec3 corner : {vec3(-5, 0, 0), vec3(3, -4, 0), vec3(4, 6, 0), vec3(0, 1, 18)}) {
        town.positions.push_back(place + corner);
    }
    for (const uvec3 corners : {uvec3(0, 1, 3), uvec3(1, 2, 3), uvec3(2, 0, 3), uvec3(1, 0, 2)}) {
        town.triangles.push_back({corners + base, material});
    }
    town.buildings.push_back({24, 4, 0, 0, 3});
    town.addWindow(place + vec3(-19.99f, 0, 10), {0, 0.5f, 0}, {0, 0, 0.5f}, 50, vec3(1), false);
    town.addMediaBox(place - vec3(100, 100, 0), place + vec3(100, 100, 60), 0.01f, 0.9f, {0});
    town.addCamera("camera", place + vec3(0, -90, 30), place, 40);
    return town.load();
}

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    vec3 within(vec3 half) {
        std::uniform_real_distribution<float> share(-1, 1);
        const vec3 at{share(engine_), share(engine_), share(engine_)};
        return at * half;
    }
    bool coin() { return (engine_() & 1u) != 0; }

private:
    std::mt19937 engine_;
};

std::set<std::uint32_t> facesOf(const OccludersAnswer& answer) {
    EXPECT_LE(answer.count, kMostFaces);
    return {answer.face, answer.face + std::min(answer.count, kMostFaces)};
}

// In the order of HullRegion.
std::array<glm::dvec3, 8> cornersOf(glm::dvec3 centre, glm::dvec3 half) {
    constexpr double kSide[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    std::array<glm::dvec3, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) {
        corners[i] = centre + half * glm::dvec3(kSide[i % 4][0], kSide[i % 4][1], i < 4 ? -1 : 1);
    }
    return corners;
}

// Whether a face stands on the way from one point to another.
bool stands(const Occluders& judge, std::uint32_t face, glm::dvec3 from, glm::dvec3 to) {
    return blocksLine(ViewTriangle(from, to, to), judge.face(face));
}

void expectStretchesAgree(vec3 place) {
    const FlatScene scene = town(place);
    const Occluders judge(scene);
    Random random(7);
    std::vector<OccludersQuery> queries;
    for (int k = 0; k < kQueries; ++k) {
        const vec3 origin = place + vec3(0, 0, 20) + random.within({45, 45, 20});
        const vec3 begin = random.within({45, 45, 20});
        const float radius = random.coin() ? 0.0f : 2.0f;
        queries.push_back({origin, vec3(radius), begin, begin + random.within({25, 25, 15}), {}, 0});
    }
    const std::vector<OccludersAnswer> answers = onDevice(scene, queries);
    std::size_t named = 0, judged = 0, hiding = 0;
    for (std::size_t k = 0; k < queries.size(); ++k) {
        const OccludersQuery& q = queries[k];
        const std::set<std::uint32_t> faces = facesOf(answers[k]);
        const glm::dvec3 centre(q.origin), begin = centre + glm::dvec3(q.begin),
                                           end = centre + glm::dvec3(q.end);
        named += faces.size();
        judged += judge.between(cornersOf(centre, glm::dvec3(q.nearHalf)), begin, end).size();
        for (int point = 0; point < 8; ++point) {
            const glm::dvec3 apex = centre + glm::dvec3(random.within(q.nearHalf));
            for (std::uint32_t face = 0; face < judge.size(); ++face) {
                if (!shadow(ViewTriangle(apex, begin, end), judge.face(face)).isEmpty()) {
                    EXPECT_TRUE(faces.contains(face)) << "query " << k << ", face " << face;
                    ++hiding;
                }
            }
        }
    }
    EXPECT_GT(hiding, 1000u);
    EXPECT_LT(double(named), 1.5 * double(judged));
}

TEST(OccludersOnDevice, NameWhatHidesAStretchFromABall) { expectStretchesAgree(vec3(0)); }

TEST(OccludersOnDevice, NameItTenKilometresOut) {
    expectStretchesAgree(vec3(10000.3f, -9000.7f, 12.1f));
}

TEST(OccludersOnDevice, NameWhatStandsBetweenTwoBoxes) {
    const FlatScene scene = town(vec3(0));
    const Occluders judge(scene);
    Random random(8);
    std::vector<OccludersQuery> queries;
    for (int k = 0; k < kQueries; ++k) {
        const vec3 origin = vec3(0, 0, 20) + random.within({45, 45, 20});
        queries.push_back({origin, glm::abs(random.within(vec3(3))), random.within({45, 45, 20}),
                           {}, glm::abs(random.within(vec3(3))), 1});
    }
    const std::vector<OccludersAnswer> answers = onDevice(scene, queries);
    std::size_t named = 0, standing = 0;
    for (std::size_t k = 0; k < queries.size(); ++k) {
        const OccludersQuery& q = queries[k];
        const std::set<std::uint32_t> faces = facesOf(answers[k]);
        named += faces.size();
        std::set<std::uint32_t> seen;
        for (int line = 0; line < 64; ++line) {
            const glm::dvec3 from(q.origin + random.within(q.nearHalf));
            const glm::dvec3 to(q.origin + q.begin + random.within(q.farHalf));
            for (std::uint32_t face = 0; face < judge.size(); ++face) {
                if (stands(judge, face, from, to)) {
                    seen.insert(face);
                }
            }
        }
        EXPECT_TRUE(std::includes(faces.begin(), faces.end(), seen.begin(), seen.end()))
            << "query " << k;
        standing += seen.size();
    }
    EXPECT_GT(standing, 200u);
    EXPECT_LT(double(named), 2.5 * double(standing));
}

// A window a centimetre before its wall asks about no face of that wall.
TEST(OccludersOnDevice, AWallHidesNothingOfWhatStandsBeforeIt) {
    const FlatScene scene = town(vec3(0));
    const OccludersQuery query{{-19.99f, 0, 10}, {0, 0.5f, 0.5f}, {1, -9, -5}, {8, 9, 10}, {}, 0};
    EXPECT_EQ(onDevice(scene, {query})[0].count, 0u);
}

}  // namespace
}  // namespace nightcity
